// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>

#include "scene/import/raster_check.hpp"
#include "scene/model/scene.hpp"

namespace scene {

/// Size of a field before its heights are made.
struct FieldToMake : sand::FieldSize {
    bool ground = false;   // whether it gets rock, or walls where the file has no data
    bool settles = false;  // whether its sand comes to rest before the session begins
};

/// Checks that are called before the memory of a scene is taken, and the progress of its reading. The checks throw if
/// the scene does not fit. Each may be empty.
struct SizeChecks {
    /// Receives the size of a raster file before its pixels are read. The program holds all pixels while it reads them.
    std::function<void(const RasterSize& size)> raster{};
    /// Receives the size of the field before its heights are made.
    ///
    /// It is called once, as soon as the size is known. For a raster whose header marks no number as no data,
    /// that is before its pixels are read. For other rasters, it is after the edges without data have been cut off. It
    /// is not called for a terrain of points, which has no field.
    std::function<void(const FieldToMake& size)> field{};
    /// Receives the size of a raster from which edges may be cut off, before its pixels are read. It is not known yet
    /// whether the field gets walls. `field` follows.
    std::function<void(const FieldToMake& atMost)> fieldAtMost{};
    /// Receives the part of the terrain that has been read or made, 0 to 1. It never goes back. It must not throw.
    std::function<void(double share)> progress{};
};

/// Reads a scene file. Throws base::InputError with file, line and key. An error in a DEM names the DEM's line.
[[nodiscard]] Scene loadScene(const std::filesystem::path& file, const SizeChecks& checks = {});

}  // namespace scene
