// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "base/byte_stream.hpp"
#include "sand/model/surface.hpp"
#include "scene/scene.hpp"

namespace master {

/// The scene that saved sand belongs to: heights mean nothing in cells of another size or over other rock.
struct SandPlace {
    std::string scene;
    std::int32_t columns = 0, rows = 0, aspect = 0;
    double cellSize = 0;       // [scene unit]
    std::uint64_t ground = 0;  // Rules::ground, or a TIN's

    static SandPlace of(const scene::Scene& scene);
};

/// Whether a file of saved sand may be called that: letters, digits, - and _, at most 64, so that no name leads out of
/// the session's folder.
[[nodiscard]] bool isSaveName(std::string_view name);
/// SESSION/saves/NAME.sand
[[nodiscard]] std::filesystem::path saveFile(const std::filesystem::path& session, std::string_view name);

struct SavedSand {
    SandPlace place;
    std::uint64_t step = 0, stateHash = 0;  // of the session when it was saved
    base::Bytes sand;                       // sand::SurfaceCopy::encode
};

/// On disk when it returns, or what was there before still is (docs/operator.md has the format). Makes the folder.
/// Throws base::InputError in one line.
void writeSavedSand(const std::filesystem::path& file, const SavedSand& saved);
/// Only sand of that place, and whole as `read` sees it. Throws base::InputError in one line.
[[nodiscard]] SavedSand readSavedSand(const std::filesystem::path& file, const SandPlace& place,
                                      const sand::SurfaceReader& read);

}  // namespace master
