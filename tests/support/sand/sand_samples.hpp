// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>

#include "sand/replica.hpp"
#include "scene/model/scene.hpp"

/// Small scenes that several tests share.
namespace samples {

/// Returns a scene of level sand with a talus of 45 degrees, without a band. The tool has a radius of `toolCells`
/// cells.
inline scene::Scene flatScene(int columns, int rows, double toolCells = 4) {
    scene::Scene scene;
    scene.name = "flat";
    scene.terrain = sand::HeightField(columns, rows, 1.0);
    scene.rules.columns = columns;
    scene.rules.rows = rows;
    scene.rules.tuning.threshold = scene.rules.tuning.startThreshold = sand::kUnitsPerCell;
    scene.rules.tuning.sweepsPerStep = 8;
    scene.rules.stepsPerSecond = 60;
    scene.rules.tuning.tool.radius = static_cast<std::int32_t>(toolCells * sand::kProbePerCell);
    return scene;
}

/// Returns an n x n field with a cylinder of `radius` cells and `height` cells in its middle. Cells at its outline are
/// filled by their area.
inline sand::HeightField cylinder(int n, double radius, double height) {
    sand::HeightField field(n, n, 1.0);
    constexpr int kSub = 16;
    for (int y = 0; y < n; ++y) {
        for (int x = 0; x < n; ++x) {
            int inside = 0;
            for (int s = 0; s < kSub * kSub; ++s) {
                const int east = s % kSub, north = s / kSub;
                const double px = x + (east + 0.5) / kSub - n / 2.0;
                const double py = y + (north + 0.5) / kSub - n / 2.0;
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

/// Returns `edit` with the number that a master gives to it.
inline sand::Edit withNumber(std::uint64_t number, sand::Edit edit) {
    edit.number = number;
    return edit;
}

/// Returns a step of a hand that moves at random. About one step in five hovers. It runs all its sweeps.
inline sand::Step randomStep(std::uint64_t number, const sand::Rules& rules, std::mt19937& random) {
    sand::Step step{.epoch = 1, .number = number, .engaged = random() % 5 != 0, .path = {}};
    step.sweeps = std::min(rules.tuning.sweepsPerStep, rules.stepLimits().mostSweeps);
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

/// Returns a random step like randomStep(), but sometimes turned or with another tool.
inline sand::Step wildStep(std::uint64_t number, const sand::Rules& rules, std::mt19937& random) {
    sand::Step step = randomStep(number, rules, random);
    if (random() % 3 == 0) {
        // Whole numbers, because the results of libm may differ between hosts.
        constexpr std::array<std::pair<int, int>, 5> kWays{
            {{16384, 0}, {0, -16384}, {11585, 11585}, {-8192, 14189}, {-16381, -286}}};
        const auto& [x, y] = kWays.at(random() % kWays.size());
        step.heading = sand::Heading{static_cast<std::int16_t>(x), static_cast<std::int16_t>(y), random() % 2 == 0};
    }
    if (random() % 7 == 0) {
        sand::Tuning tuning = rules.tuning;
        tuning.tool.kind = static_cast<sand::ToolKind>(random() % sand::kToolKinds);
        tuning.tool.radius = static_cast<std::int32_t>(random() % (20 * sand::kProbePerCell));
        tuning.tool.halfWidth = sand::isRound(tuning.tool.kind) ? 0 : tuning.tool.radius / 3;
        step.edit = sand::Edit::tuned(tuning);
    }
    return step;
}

}  // namespace samples
