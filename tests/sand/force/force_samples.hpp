// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "sand/force/force_model.hpp"
#include "sand/replica.hpp"
#include "scene/model/scene.hpp"

/// Sand and tools for tests of the forces, at the scale of Dorjgotov et al. 2007: a sphere of radius 0.01.
namespace samples {

using sand::force::Contour;
using sand::force::Response;
using sand::force::SurfacePatch;
using sand::force::Vec3;

inline constexpr double kRadius = 0.01;
inline constexpr double kCell = kRadius / 10;  // [scene unit]
inline constexpr int kSide = 256;
inline constexpr double kMiddle = kSide * kCell / 2;
inline constexpr double kTick = 1e-3;  // [s]

inline sand::ProbePoint probeAt(Vec3 place) {
    const auto probe = [](double at) {
        return static_cast<std::int32_t>(std::lround(at / kCell * sand::kProbePerCell));
    };
    return {probe(place.x), probe(place.y), probe(place.z)};
}

/// Returns the tool's centre when its lowest point is `depth` below height 0.
inline Vec3 placeAt(double depth, double east = 0, double north = 0) {
    return {kMiddle + east, kMiddle + north, kRadius - depth};
}

/// Returns a patch around the middle of a field. `height` gives the heights [scene unit] at (east, north) of that
/// middle.
template <class Height>
SurfacePatch patchOf(const Height& height, double reach = kRadius) {
    sand::HeightField field(kSide, kSide, kCell);
    for (int row = 0; row < kSide; ++row) {
        for (int column = 0; column < kSide; ++column) {
            const double h = height((column + 0.5) * kCell - kMiddle, (row + 0.5) * kCell - kMiddle);
            field.setHeight(column, row, static_cast<std::int32_t>(std::lround(h / field.unit())));
        }
    }
    return {field, probeAt({kMiddle, kMiddle, 0}), reach};
}
inline SurfacePatch levelPatch() {
    return patchOf([](double, double) { return 0.0; });
}
/// Returns a slope that rises to the east.
inline SurfacePatch slopePatch(double slope) {
    return patchOf([slope](double east, double) { return slope * east; });
}
/// Returns heaps and holes of a few cells, up to a radius high.
inline SurfacePatch roughPatch(std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> phase(0, 6.28);
    const double a = phase(random), b = phase(random), c = phase(random);
    return patchOf([&](double x, double y) {
        return kRadius / 3 * (std::sin(140 * x + a) + std::sin(190 * y + b) + std::sin(230 * x - 310 * y + c));
    });
}

/// Returns level sand with a tool of ten cells, at sixty steps per second.
inline scene::Scene levelScene(std::int32_t sweepsPerStep = 40) {
    scene::Scene scene;
    scene.terrain = sand::HeightField(kSide, kSide, kCell);
    scene.rules = {.columns = kSide,
                   .rows = kSide,
                   .tuning = {.threshold = 44204,
                              .startThreshold = 44248,
                              .sweepsPerStep = sweepsPerStep,
                              .tool = {.radius = 10 * sand::kProbePerCell}},
                   .stepsPerSecond = 60};
    return scene;
}

inline sand::ForceConstants constantsOf(sand::ForceLaw law, sand::Between between = sand::Between::local) {
    sand::ForceConstants constants;
    constants.law = law;
    constants.between = between;
    constants.unitLength = kSide * kCell;
    return constants;
}
inline constexpr std::array kLaws{sand::ForceLaw::repulse, sand::ForceLaw::controlPoints};

}  // namespace samples
