// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "scene/load/scene_file.hpp"
#include "scene/model/session_memory.hpp"

namespace scene {

/// Returns the size of the sand that a scene file makes. Reads headers alone, and no pixels: it counts edges without
/// data, which may be cut off. Returns nullopt for a terrain of points. Throws base::InputError for a file whose size
/// cannot be read. Other errors stay unnoticed.
[[nodiscard]] std::optional<SandSize> sizeOfScene(const std::filesystem::path& file);

/// Collects what the memory of a scene depends on, while its file is read.
class SizeCollector {
public:
    /// Called for a raster, before its pixels are read.
    void addRaster(const RasterSize& size);
    /// Returns checks that collect, and refuse nothing. The collector must outlive them.
    [[nodiscard]] SizeChecks checks();
    /// Returns the size of the sand of `scene`, which was loaded with checks().
    [[nodiscard]] SandSize of(const Scene& scene) const;
    /// Returns the size of the sand if `field` is its field.
    [[nodiscard]] SandSize with(const FieldToMake& field) const;

private:
    std::int64_t rasterBytes_ = 0;  // of the largest
    bool settles_ = false;
};

}  // namespace scene
