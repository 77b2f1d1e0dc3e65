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

/// The scene that saved sand belongs to. Heights have no meaning in cells of another size or over other rock.
struct SandPlace {
    std::string scene;
    std::int32_t columns = 0, rows = 0, aspect = 0;
    double cellSize = 0;       // [scene unit]
    std::uint64_t ground = 0;  // Rules::siteDigest()

    static SandPlace of(const scene::Scene& scene);
};

/// Returns whether `name` is a valid name for saved sand: 1 to 64 letters, digits, - and _. Such a name cannot lead out
/// of the session's folder.
[[nodiscard]] bool isSaveName(std::string_view name);
/// Returns SESSION/saves/NAME.sand.
[[nodiscard]] std::filesystem::path saveFile(const std::filesystem::path& session, std::string_view name);

struct SavedSand {
    SandPlace place;
    std::uint64_t step = 0, stateHash = 0;  // of the session when the sand was saved
    base::Bytes sand;                       // sand::SurfaceCopy::encode()
};

/// Writes saved sand, which is on disk when the function returns (format: docs/operator.md). Makes the folder. If it
/// fails, throws base::InputError with one line, and an earlier file stays unchanged.
void writeSavedSand(const std::filesystem::path& file, const SavedSand& saved);
/// Reads saved sand. Throws base::InputError with one line if the file cannot be read, if its sand belongs to another
/// place than `place`, or if `read` cannot decode it.
[[nodiscard]] SavedSand readSavedSand(const std::filesystem::path& file, const SandPlace& place,
                                      const sand::SurfaceReader& read);

}  // namespace master
