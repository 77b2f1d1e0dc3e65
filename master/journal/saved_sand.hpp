// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "base/field_forms.hpp"
#include "sand/model/surface.hpp"
#include "scene/model/scene.hpp"

namespace master {

inline constexpr std::size_t kLongestSceneName = 2048;  // [byte] in a file of saved sand, which cuts off the rest

/// The scene that saved sand belongs to. Heights have no meaning in cells of another size or over other rock.
struct SandPlace {
    std::string scene;
    std::int32_t columns = 0, rows = 0, aspect = 0;
    double cellSize = 0;       // [scene unit]
    std::uint64_t ground = 0;  // Rules::siteDigest()
    /// Largest size of its sand in a step, sand::StepLimits::mostSandBytes [byte]. Not in the file.
    std::int64_t mostBytes = sand::kMaxSandBytes;

    static SandPlace of(const scene::Scene& scene);

    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("scene", base::text(it.scene, kLongestSceneName));
        visit("columns", it.columns);
        visit("rows", it.rows);
        visit("aspect", it.aspect);
        visit("cell_size", it.cellSize);
        visit("ground", it.ground);
    }
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

    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("place", it.place);
        visit("step", it.step);
        visit("state_hash", it.stateHash);
        visit("sand", base::block(it.sand));
    }
};

/// Writes saved sand, which is on disk when the function returns (format: docs/operator.md). Makes the folder. If it
/// fails, throws base::InputError with one line, and an earlier file stays unchanged.
void writeSavedSand(const std::filesystem::path& file, const SavedSand& saved);
/// Reads a file of saveFile(). Throws base::InputError with one line if the file or its folder is a link or cannot be
/// read, if its sand belongs to another place than `place`, or if `read` cannot decode it.
[[nodiscard]] SavedSand readSavedSand(const std::filesystem::path& file, const SandPlace& place,
                                      const sand::SurfaceReader& read);

}  // namespace master
