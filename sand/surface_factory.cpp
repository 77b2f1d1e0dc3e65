// SPDX-License-Identifier: Apache-2.0
#include "sand/surface_factory.hpp"

#include "base/float_environment.hpp"
#include "sand/grid/surface.hpp"
#include "sand/tin/refine/start_maker.hpp"
#include "sand/tin/surface.hpp"

namespace sand {

std::unique_ptr<Surface> makeSurface(const Start& start, const base::Executor* executor) {
    (void)base::needDefaultFloats();
    if (start.tin != nullptr) {
        return std::make_unique<tin::TinSurface>(start.rules, start.tin);
    }
    return std::make_unique<grid::GridSurface>(start.rules, start.terrain, start.ground,
                                               grid::Erosion::Options{.executor = executor});
}

std::int64_t volumeOf(const Start& start) {
    return start.tin != nullptr ? makeSurface(start)->volume() : start.terrain.volume();
}

HeightAt startHeights(const Start& start) {
    if (start.tin != nullptr) {
        const std::shared_ptr<const Surface> tin = makeSurface(start);
        return [tin](double x, double y) { return tin->height(x, y); };
    }
    return [&field = start.terrain](double x, double y) { return field.interpolated(x, y); };  // it needs no copy
}

void startFrom(const Surface& surface, Start& start) {
    const SurfaceData data = surface.data();
    if (const auto* grid = std::get_if<GridData>(&data)) {
        start.terrain = grid->field;
    } else {
        const auto& tin = dynamic_cast<const tin::TinSurface&>(surface);
        start.beginAs(tin::startOf(tin.layer(), tin.start().settings));
    }
}

}  // namespace sand
