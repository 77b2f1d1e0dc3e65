// SPDX-License-Identifier: Apache-2.0
#include "sand/tin_raster.hpp"

#include <cmath>

namespace sand {

HeightField sampled(const Terrain& terrain) {
    HeightField field(terrain.rules().columns, terrain.rules().rows, terrain.cellSize());
    for (int row = 0; row < field.rows(); ++row) {
        for (int column = 0; column < field.columns(); ++column) {
            const double height = terrain.surface().height((column + 0.5) * kProbePerCell, (row + 0.5) * kProbePerCell);
            field.setHeight(column, row, static_cast<std::int32_t>(std::floor(height + 0.5)));
        }
    }
    return field;
}

Scene sampledScene(const Scene& scene) {
    Scene result = scene;
    result.terrain = sampled(Terrain(scene));
    return result;
}

Mesh meshOf(const tin::SurfaceView& tin, const Scene& scene) {
    const Georeference& reference = scene.georeference;
    const double length = scene.terrain.cellSize() / kProbePerCell * reference.lengthPerUnit;
    Mesh mesh;
    std::vector<std::uint32_t> numbers(tin.triangles.places.size(), 0);
    for (std::size_t i = 0; i < tin.triangles.places.size(); ++i) {
        if (tin.triangles.alive(static_cast<tin::Vertex>(i))) {
            numbers[i] = static_cast<std::uint32_t>(mesh.vertices.size());
            const tin::Place place = tin.triangles.places[i];
            mesh.vertices.push_back(
                {reference.west + place.x * length, reference.south + place.y * length,
                 (tin.heights[i] * scene.terrain.unit() + reference.datum) * reference.heightPerUnit});
        }
    }
    for (const tin::Triangle& triangle : tin.triangles.triangles) {
        if (triangle.alive()) {
            const auto number = [&](std::size_t corner) {
                return numbers[static_cast<std::size_t>(triangle.corner[corner])];
            };
            mesh.triangles.push_back({number(0), number(1), number(2)});
        }
    }
    return mesh;
}

}  // namespace sand
