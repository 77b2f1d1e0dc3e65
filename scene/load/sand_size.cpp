// SPDX-License-Identifier: Apache-2.0
#include "scene/load/sand_size.hpp"

#include <algorithm>

#include "base/input_error.hpp"
#include "host/toml_table.hpp"

namespace scene {
namespace {

/// Thrown when the size is known, so that nothing is read after it.
class SizeIsKnown : public base::InputError {
public:
    using base::InputError::InputError;
};

}  // namespace

void SizeCollector::addRaster(const RasterSize& size) { rasterBytes_ = std::max(rasterBytes_, size.bytes()); }

SizeChecks SizeCollector::checks() {
    return {.raster = [this](const RasterSize& size) { addRaster(size); },
            .field = [this](const FieldToMake& field) { settles_ = field.settles; }};
}

SandSize SizeCollector::of(const Scene& scene) const {
    SandSize size = SandSize::of(scene);
    size.rasterBytes = rasterBytes_;
    size.settles = settles_;
    return size;
}

SandSize SizeCollector::with(const FieldToMake& field) const {
    return {.field = field, .ground = field.ground, .rasterBytes = rasterBytes_, .settles = field.settles};
}

std::optional<SandSize> sizeOfScene(const std::filesystem::path& file) {
    const host::TomlTable toml = host::TomlTable::load(file);
    if (const auto terrain = toml.table("terrain");
        terrain && terrain->has("kind") && terrain->text("kind") == "points") {
        return std::nullopt;
    }
    SizeCollector collector;
    std::optional<SandSize> size;
    const auto know = [&](const FieldToMake& field) {
        size = collector.with(field);
        throw SizeIsKnown("the size is known");
    };
    try {
        (void)loadScene(file, {.raster = [&](const RasterSize& raster) { collector.addRaster(raster); },
                               .field = know,
                               .fieldAtMost = know});
    } catch (const base::InputError&) {
        if (!size) {
            throw;
        }
    }
    return size;
}

}  // namespace scene
