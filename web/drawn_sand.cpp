// SPDX-License-Identifier: Apache-2.0
#include "web/drawn_sand.hpp"

#include <algorithm>
#include <variant>

#include "sand/model/probe_point.hpp"
#include "sand/tin/geometry/surface_view.hpp"

namespace web {
void DrawnSand::take(const sand::Surface& surface) {
    const sand::SurfaceData data = surface.data();
    if (const auto* const grid = std::get_if<sand::GridData>(&data)) {
        meshed = false;
        heights.clear();
        for (int y = 0; y < grid->field.rows(); ++y) {
            heights.insert(heights.end(), grid->field.row(y), grid->field.row(y) + grid->field.columns());
        }
        return;
    }
    const sand::tin::SurfaceView& view = std::get<sand::TinData>(data).view;
    meshed = true;
    corners.clear();
    for (const sand::tin::Triangle& triangle : view.triangles.triangles) {
        if (triangle.isGround()) {
            corners.insert(corners.end(), triangle.corner.begin(), triangle.corner.end());
        }
    }
    places.clear();
    for (std::size_t i = 0; i < view.triangles.places.size(); ++i) {
        const sand::tin::LatticePoint& place = view.triangles.places[i];
        places.insert(places.end(), {static_cast<float>(place.x) / sand::kProbePerCell,
                                     static_cast<float>(place.y) / sand::kProbePerCell,
                                     static_cast<float>(view.heights[i] / sand::kUnitsPerCell)});
    }
}

bool DrawnSand::takeHoles(const sand::Surface& surface) {
    const sand::SurfaceData data = surface.data();
    const auto* const grid = std::get_if<sand::GridData>(&data);
    holes.clear();
    for (int y = 0; grid != nullptr && grid->ground != nullptr && y < grid->field.rows(); ++y) {
        for (int x = 0; x < grid->field.columns(); ++x) {
            holes.push_back(grid->ground->isWall(x, y) ? 1 : 0);
        }
    }
    return std::find(holes.begin(), holes.end(), 1) != holes.end();
}

}  // namespace web
