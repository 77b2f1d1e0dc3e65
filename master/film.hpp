// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "lockstep/cluster.hpp"
#include "lockstep/watchdog.hpp"
#include "walls/wall.hpp"

namespace master {

/// What a film shows of a wall that draws two eyes.
enum class FilmEye : std::uint8_t { left, right, anaglyph };
/// Throws base::InputError for any word but "left", "right" and "anaglyph".
[[nodiscard]] FilmEye filmEyeNamed(const std::string& name);

/// The pictures of a film of the whole wall: FOLDER/frame_000001.png and so on. One thread.
///
/// Every picture is put together from all tiles: the only eye's of a wall that draws one; both eyes' packed as the
/// wall's stereo says, as if the wall were one tile; of a wall that keeps the eyes apart the left one.
class Film {
public:
    /// `eye` is shown instead. Throws base::InputError when the wall does not draw two eyes for it or has too many
    /// pixels for one picture. The wall must outlive the film.
    Film(const walls::Wall& wall, std::optional<FilmEye> eye, std::filesystem::path folder);

    /// Receives the pictures that all ranks are sending and writes one. Throws base::InputError when it cannot, after
    /// all were received.
    void take(const lockstep::Cluster& cluster, lockstep::Watchdog& watchdog);

    /// Removes what a film before has left in a folder.
    static void forget(const std::filesystem::path& folder);

private:
    const walls::Wall& wall_;
    std::optional<FilmEye> eye_;
    std::filesystem::path folder_;
    std::uint64_t frames_ = 0;
};

}  // namespace master
