// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>

#include "scene/scene.hpp"

namespace scene {

/// What is asked before a scene's memory is taken. Both throw if it does not fit; either may be empty.
struct SizeChecks {
    /// Receives the size of a raster file before its pixels are read. While this program reads them it holds them all.
    std::function<void(int columns, int rows)> raster{};
    /// Receives the size of the height field before its heights are made. With `tin`, a TIN is made of it and these are
    /// its nominal cells. Called once, as soon as the size is known: for a raster whose header marks no data, before
    /// its pixels are read; for others when its edges without data have been cut off. Never called for a terrain of
    /// points, which makes no field.
    std::function<void(int columns, int rows, bool tin)> field{};
};

/// Reads a scene file. Throws base::InputError with file, line and key; a DEM's errors name the DEM's line.
[[nodiscard]] Scene loadScene(const std::filesystem::path& file, const SizeChecks& checks = {});

}  // namespace scene
