// SPDX-License-Identifier: Apache-2.0
#include "sand/scene_tin.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sand/tin_module.hpp"

namespace sand {
namespace {

constexpr double kMostVolume = 4.6e18;  // 2^62 volume units, all of whose sums stay within 64 bits

tin::Settings readSettings(const files::TomlTable& tin, double cellSize) {
    tin::Settings settings;
    const double finest = cellSize / kProbePerCell;
    const double spacing = tin.numberOr("spacing", cellSize, {finest, 1e9});
    settings.spacing = static_cast<std::int32_t>(std::min(std::floor(spacing / finest + 0.5), double{kMaxProbe}));
    const double error = tin.numberOr("max_error", cellSize / 16, {0, 1e9});
    settings.maxError = static_cast<std::int32_t>(
        std::min(std::floor(error / cellSize * kUnitsPerCell + 0.5), static_cast<double>(kMaxHeight)));
    settings.mostVertices = tin.integerOr("vertices", settings.mostVertices, 4, 1 << 22);
    settings.keepConstraints = tin.flagOr("keep_constraints", settings.keepConstraints);
    return settings;
}

void setTin(tin::Start start, Scene& scene) {
    scene.tin = std::make_shared<const tin::Start>(std::move(start));
    scene.rules.tin = scene.tin->digest();
    scene.terrain = HeightField(1, 1, scene.terrain.cellSize());
}

}  // namespace

void readTin(const files::TomlTable& file, Scene& scene) {
    const auto tin = file.table("tin");
    if (!tin) {
        return;
    }
    if (scene.ground != nullptr) {
        file.fail(
            "tin",
            "a TIN has neither rock nor cells without data; leave out [tin], 'layer' and 'bedrock', or fill the gaps");
    }
    const HeightField& field = scene.terrain;
    std::int32_t highest = 0;
    for (int row = 0; row < field.rows(); ++row) {
        for (int column = 0; column < field.columns(); ++column) {
            highest = std::max(highest, std::abs(field.height(column, row)));
        }
    }
    const double area = 6.0 * field.columns() * field.rows() * kProbePerCell * kProbePerCell;
    if (highest * area > kMostVolume) {
        file.fail("tin", fmt::format(
                             "heights of up to {} on {} x {} cells are more than a TIN's volumes can hold, {} is "
                             "the most; set 'datum', or fewer cells",
                             highest * field.unit(), field.columns(), field.rows(), kMostVolume / area * field.unit()));
    }
    const tin::Settings settings = readSettings(*tin, field.cellSize());
    tin->finish();
    setTin(tinModule().follow(field, settings), scene);
}

void startFrom(const Terrain& terrain, Scene& scene) {
    if (scene.tin != nullptr) {
        setTin(tinModule().startOf(terrain.surface()), scene);
    } else {
        scene.terrain = terrain.field();
    }
}

}  // namespace sand
