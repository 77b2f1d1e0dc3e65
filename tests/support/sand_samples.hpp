// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "sand/scene.hpp"
#include "sand/terrain.hpp"

/// Small worlds that several tests share.
namespace samples {

/// Level sand, talus 45 degrees, no band, a tool of `toolCells` cells.
inline sand::Scene flatScene(int columns, int rows, double toolCells = 4) {
    sand::Scene scene;
    scene.name = "flat";
    scene.terrain = sand::HeightField(columns, rows, 1.0);
    scene.rules.columns = columns;
    scene.rules.rows = rows;
    scene.rules.threshold = scene.rules.startThreshold = sand::kUnitsPerCell;
    scene.rules.sweepsPerStep = 8;
    scene.rules.stepsPerSecond = 60;
    scene.rules.toolRadius = static_cast<std::int32_t>(toolCells * sand::kProbePerCell);
    return scene;
}

/// A cylinder of `radius` cells and `height` cells in the middle of an N x N field, its rim cells filled by area.
inline sand::HeightField cylinder(int n, double radius, double height) {
    sand::HeightField field(n, n, 1.0);
    constexpr int kSub = 16;
    for (int y = 0; y < n; ++y) {
        for (int x = 0; x < n; ++x) {
            int inside = 0;
            for (int s = 0; s < kSub * kSub; ++s) {
                const double px = x + (s % kSub + 0.5) / kSub - n / 2.0;
                const double py = y + (s / kSub + 0.5) / kSub - n / 2.0;
                inside += px * px + py * py < radius * radius ? 1 : 0;
            }
            field.setHeight(x, y, static_cast<std::int32_t>(height * sand::kUnitsPerCell * inside / (kSub * kSub)));
        }
    }
    return field;
}

inline sand::HeightField randomField(int columns, int rows, std::int32_t range, std::mt19937& random) {
    sand::HeightField field(columns, rows, 1.0);
    for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < columns; ++x) {
            field.setHeight(x, y, static_cast<std::int32_t>(random() % static_cast<std::uint32_t>(range)));
        }
    }
    return field;
}

/// A hand that wanders through the sand without any sense: about one step in five hovers.
inline sand::Step randomStep(std::uint64_t number, const sand::Rules& rules, std::mt19937& random) {
    sand::Step step{.epoch = 1, .number = number, .engaged = random() % 5 != 0, .path = {}};
    const auto within = [&random](std::int32_t cells) {
        return static_cast<std::int32_t>(random() % static_cast<std::uint32_t>((cells + 8) * sand::kProbePerCell)) -
               4 * sand::kProbePerCell;
    };
    const auto points = random() % 4;
    for (unsigned i = 0; i < points; ++i) {
        step.path.push_back({within(rules.columns), within(rules.rows), within(4)});
    }
    return step;
}

}  // namespace samples
