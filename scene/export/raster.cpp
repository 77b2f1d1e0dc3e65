// SPDX-License-Identifier: Apache-2.0
#include "scene/export/raster.hpp"

#include <limits>
#include <stdexcept>
#include <vector>

namespace scene {
namespace {

void wantSameCells(const sand::HeightField& field, const Scene& scene) {
    if (field.columns() != scene.terrain.columns() || field.rows() != scene.terrain.rows()) {
        throw std::invalid_argument("field and scene have different numbers of cells");
    }
}

bool isWall(const Scene& scene, int column, int row) {
    return scene.ground != nullptr && scene.ground->isWall(column, row);
}

/// Returns a raster of the scene's cells. A cell that is not a wall has the height `heightOf(column, row)` [unit] +
/// `datum` [scene unit].
template <class HeightOf>
EsriGrid rasterOf(const Scene& scene, double datum, HeightOf heightOf) {
    const Georeference& reference = scene.georeference;
    const sand::HeightField& field = scene.terrain;
    EsriGrid grid;
    grid.columns = field.columns();
    grid.rows = field.rows();
    grid.cellSize = field.cellSize() * reference.lengthPerUnit;
    grid.westEdge = reference.west;
    grid.southEdge = reference.south;
    grid.units = reference.units;
    const double finest = field.unit() * reference.heightPerUnit;
    grid.heights.reserve(static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows));
    for (int row = grid.rows - 1; row >= 0; --row) {
        for (int column = 0; column < grid.columns; ++column) {
            const double height = (heightOf(column, row) * field.unit() + datum) * reference.heightPerUnit;
            grid.heights.add(isWall(scene, column, row) ? std::numeric_limits<double>::quiet_NaN()
                                                        : withFewDecimals(height, finest));
        }
    }
    return grid;
}

}  // namespace

EsriGrid heightsOf(const sand::HeightField& field, const Scene& scene) {
    wantSameCells(field, scene);
    return rasterOf(scene, scene.georeference.datum,
                    [&](int column, int row) { return static_cast<double>(field.height(column, row)); });
}

EsriGrid differenceOf(const sand::HeightField& field, const Scene& scene) {
    wantSameCells(field, scene);
    return rasterOf(scene, 0, [&](int column, int row) {
        return static_cast<double>(field.height(column, row)) - scene.terrain.height(column, row);
    });
}

Mesh meshOf(const sand::HeightField& field, const Scene& scene) {
    const EsriGrid grid = heightsOf(field, scene);
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    Mesh mesh;
    std::vector<std::uint32_t> numbers;  // index of each cell's vertex, row by row from the south-west
    numbers.reserve(grid.heights.size());
    for (int row = 0; row < grid.rows; ++row) {
        for (int column = 0; column < grid.columns; ++column) {
            if (grid.isNoData(column, row)) {
                numbers.push_back(kNone);
                continue;
            }
            numbers.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
            mesh.vertices.push_back({grid.westEdge + (column + 0.5) * grid.cellSize,
                                     grid.southEdge + (row + 0.5) * grid.cellSize, grid.at(column, row)});
        }
    }
    const auto columns = static_cast<std::size_t>(grid.columns);
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        if (a != kNone && b != kNone && c != kNone) {
            mesh.triangles.push_back({a, b, c});
        }
    };
    for (std::size_t southWest = 0; southWest + columns < numbers.size(); ++southWest) {
        if (southWest % columns + 1 == columns) {
            continue;
        }
        const std::uint32_t* south = &numbers[southWest];
        const std::uint32_t* north = south + columns;
        add(south[0], south[1], north[1]);
        add(south[0], north[1], north[0]);
    }
    return mesh;
}

Earthwork earthworkOf(const sand::HeightField& field, const Scene& scene) {
    wantSameCells(field, scene);
    Earthwork work;
    for (int row = 0; row < field.rows(); ++row) {
        for (int column = 0; column < field.columns(); ++column) {
            const std::int64_t change = std::int64_t{field.height(column, row)} - scene.terrain.height(column, row);
            (change < 0 ? work.cut : work.fill) += change < 0 ? -change : change;
        }
    }
    work.unit = field.unit() * field.cellSize() * field.cellSize();
    work.cubicMetres = work.unit * scene.georeference.cubicMetres();
    return work;
}

}  // namespace scene
