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
