// SPDX-License-Identifier: Apache-2.0
#include "scene/export/tin_raster.hpp"

#include <cmath>

#include "sand/tin/geometry/surface_view.hpp"

namespace scene {

sand::HeightField sampled(const sand::Replica& replica, const sand::tin::Holes* holes) {
    sand::HeightField field(replica.rules().columns, replica.rules().rows, replica.cellSize());
    for (int row = 0; row < field.rows(); ++row) {
        for (int column = 0; column < field.columns(); ++column) {
            if (holes != nullptr && holes->isHole(column, row)) {
                continue;
            }
            const double height =
                replica.surface().height((column + 0.5) * sand::kProbePerCell, (row + 0.5) * sand::kProbePerCell);
            field.setHeight(column, row, static_cast<std::int32_t>(std::floor(height + 0.5)));
        }
    }
    return field;
}

Scene sampledScene(const Scene& scene) {
    Scene result = scene;
    const sand::tin::Holes* holes = scene.tin->holes.get();
    result.terrain = sampled(sand::Replica(scene), holes);
    if (holes != nullptr) {
        auto ground = std::make_shared<sand::Ground>(scene.rules.columns, scene.rules.rows);
        for (const sand::tin::Holes::Run& run : holes->runs()) {
            for (int column = run.first; column < run.end; ++column) {
                ground->setWall(column, run.row);
            }
        }
        result.ground = std::move(ground);
    }
    return result;
}

Mesh meshOf(const sand::tin::SurfaceView& tin, const Scene& scene) {
    const Georeference& reference = scene.georeference;
    const double length = sand::probeUnit(scene.terrain.cellSize()) * reference.lengthPerUnit;
    Mesh mesh;
    std::vector<std::uint32_t> numbers(tin.triangles.places.size(), 0);
    std::vector<bool> onGround(numbers.size(), false);
    for (const sand::tin::Triangle& triangle : tin.triangles.triangles) {
        for (std::size_t corner = 0; corner < 3 && triangle.isGround(); ++corner) {
            onGround[static_cast<std::size_t>(triangle.corner[corner])] = true;
        }
    }
    for (std::size_t i = 0; i < tin.triangles.places.size(); ++i) {
        if (onGround[i]) {
            numbers[i] = static_cast<std::uint32_t>(mesh.vertices.size());
            const sand::tin::LatticePoint place = tin.triangles.places[i];
            mesh.vertices.push_back(
                {reference.west + place.x * length, reference.south + place.y * length,
                 (tin.heights[i] * scene.terrain.unit() + reference.datum) * reference.heightPerUnit});
        }
    }
    for (const sand::tin::Triangle& triangle : tin.triangles.triangles) {
        if (triangle.isGround()) {
            const auto number = [&](std::size_t corner) {
                return numbers[static_cast<std::size_t>(triangle.corner[corner])];
            };
            mesh.triangles.push_back({number(0), number(1), number(2)});
        }
    }
    return mesh;
}

}  // namespace scene
