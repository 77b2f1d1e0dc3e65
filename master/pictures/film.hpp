// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "base/names.hpp"
#include "lockstep/frame_barrier.hpp"
#include "walls/wall.hpp"

namespace master {

/// Picture that a film shows of a wall that draws two eyes.
enum class FilmEye : std::uint8_t { left, right, anaglyph };
constexpr auto valuesOf(FilmEye) {
    return std::array{base::Named{FilmEye::left, "left"}, base::Named{FilmEye::right, "right"},
                      base::Named{FilmEye::anaglyph, "anaglyph"}};
}

/// Writes the pictures of a film of the whole wall: FOLDER/frame_000001.png and so on. Used by one thread.
///
/// Each picture is put together from all tiles. On a wall that draws one eye, it is the picture of this eye. If the
/// wall's stereo mode packs both eyes into one picture, the film does so too, as if the wall were one tile. It
/// swaps the eyes if the wall does. On other walls with two eyes, the film shows the left eye.
class Film {
public:
    /// With `eye` the film shows this eye instead. Throws base::InputError if `eye` is given and the wall draws only
    /// one eye, or if the wall has too many pixels for one picture. The wall must outlive the film.
    Film(const walls::Wall& wall, std::optional<FilmEye> eye, std::filesystem::path folder);

    /// Receives the pictures that all ranks are sending, and writes the film's next picture. Throws base::InputError if
    /// it cannot be written, after all pictures were received.
    void take(lockstep::FrameBarrier& barrier);

    /// Removes the files of an earlier film from `folder`.
    static void forget(const std::filesystem::path& folder);

private:
    const walls::Wall& wall_;
    std::optional<FilmEye> eye_;
    std::filesystem::path folder_;
    std::uint64_t frames_ = 0;
};

}  // namespace master
