// SPDX-License-Identifier: Apache-2.0
#include "scene/import/grid_terrain.hpp"

#include <algorithm>

namespace scene {

void layTerrain(const EsriGrid& grid, const std::function<std::int32_t(double height)>& unitsOf,
                sand::HeightField& field, std::shared_ptr<sand::Ground>& ground,
                const std::function<void(double share)>& laid) {
    std::int32_t lowest = sand::kMaxHeight;
    for (int row = 0; row < grid.rows; ++row) {
        if (laid) {
            laid(static_cast<double>(row) / grid.rows);
        }
        for (int column = 0; column < grid.columns; ++column) {
            if (!grid.isNoData(column, row)) {
                const std::int32_t units = unitsOf(grid.at(column, row));
                field.setHeight(column, row, units);
                lowest = std::min(lowest, units);
            }
        }
    }
    for (int row = 0; row < grid.rows; ++row) {
        for (int column = 0; column < grid.columns; ++column) {
            if (grid.isNoData(column, row)) {
                field.setHeight(column, row, lowest);
                if (ground == nullptr) {
                    ground = std::make_shared<sand::Ground>(grid.columns, grid.rows);
                }
                ground->setWall(column, row);
            }
        }
    }
}

}  // namespace scene
