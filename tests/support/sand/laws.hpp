// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "sand/model/height_field.hpp"
#include "sand/model/rules.hpp"
#include "scene/model/material.hpp"

/// The laws by which sand slides, and how steep sand is at rest. Tests and benchmarks share them.
namespace samples {

/// All schemes. The default comes first.
inline constexpr auto kSchemes = [] {
    std::array<sand::Scheme, valuesOf(sand::Scheme{}).size()> schemes{};
    std::ranges::transform(valuesOf(sand::Scheme{}), schemes.begin(), &base::Named<sand::Scheme>::value);
    return schemes;
}();

/// The band of scenes that do not set one.
inline constexpr double kDefaultBand = scene::Material{}.band;

/// A scheme and a band, which decide how sand slides. Converts from a scheme alone, without a band.
struct Law {
    sand::Scheme scheme = sand::Scheme::isotropic;
    double band = 0;  // share by which the slope that starts a slide exceeds the threshold

    Law() = default;
    Law(sand::Scheme of, double width = 0) : scheme(of), band(width) {}  // NOLINT(google-explicit-constructor)
    [[nodiscard]] bool inertial() const { return scheme == sand::Scheme::isotropic; }
    // clang-tidy 14 takes the comparison with 0 in the generated code for a null pointer.
    friend auto operator<=>(const Law&, const Law&) = default;  // NOLINT(modernize-use-nullptr)
};

/// Returns every scheme, both without a band and with the default band.
inline std::vector<Law> laws() {
    std::vector<Law> all;
    for (const sand::Scheme scheme : kSchemes) {
        all.insert(all.end(), {{scheme}, {scheme, kDefaultBand}});
    }
    return all;
}

inline std::string nameOf(const Law& law) {
    return fmt::format("scheme {}, band {}", base::nameOf(law.scheme), law.band);
}

/// Returns rules for a field with a closed rim and square cells. By default the threshold is 45 degrees, without a
/// band.
inline sand::Rules rulesFor(const sand::HeightField& field, const Law& law = {},
                            std::int32_t threshold = sand::kUnitsPerCell) {
    sand::Rules rules;
    rules.columns = field.columns();
    rules.rows = field.rows();
    rules.tuning.threshold = threshold;
    rules.tuning.startThreshold = threshold + static_cast<std::int32_t>(law.band * threshold);
    rules.scheme = law.scheme;
    return rules;
}

/// The lowest and the highest height of a field [unit].
struct Extremes {
    std::int32_t lowest, highest;
};

inline Extremes extremesOf(const sand::HeightField& field) {
    Extremes result{field.height(0, 0), field.height(0, 0)};
    for (int y = 0; y < field.rows(); ++y) {
        const auto [low, high] = std::minmax_element(field.row(y), field.row(y) + field.columns());
        result = {std::min(result.lowest, *low), std::max(result.highest, *high)};
    }
    return result;
}

/// Returns the slope m at the steepest face of a field of square cells, minus the threshold [unit]. Scheme G measures m
/// in this way.
inline double steepestExcess(const sand::HeightField& field, std::int32_t threshold) {
    const int columns = field.columns();
    const int rows = field.rows();
    // Beyond the rim the slope of the ground continues.
    const auto height = [&](int x, int y) {
        const auto inRow = [&](int row) {
            const auto cell = [&](int column) { return static_cast<double>(field.height(column, row)); };
            if (x < 0) {
                return 2 * cell(0) - cell(std::min(1, columns - 1));
            }
            return x < columns ? cell(x) : 2 * cell(columns - 1) - cell(std::max(columns - 2, 0));
        };
        if (y < 0) {
            return 2 * inRow(0) - inRow(std::min(1, rows - 1));
        }
        return y < rows ? inRow(y) : 2 * inRow(rows - 1) - inRow(std::max(rows - 2, 0));
    };
    double steepest = 0;
    for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < columns; ++x) {
            // From (x, y) to its neighbour (dx, dy) ahead; (dy, dx) is the direction along the face.
            for (const auto& [dx, dy] : {std::pair{1, 0}, {0, 1}}) {
                if (x + dx < columns && y + dy < rows) {
                    const double across = height(x, y) - height(x + dx, y + dy);
                    const double along = 0.25 * (height(x + dy, y + dx) - height(x - dy, y - dx) +
                                                 height(x + 1, y + 1) - height(x + dx - dy, y + dy - dx));
                    steepest = std::max(steepest, std::hypot(across, along));
                }
            }
        }
    }
    return steepest - threshold;
}

/// Returns the largest excess over the threshold that a face may have at rest [unit]. A flux below one unit moves no
/// sand. Sand that has never slid rests up to the start threshold.
inline double restingExcess(std::int32_t threshold, const Law& law = {}) {
    return std::cbrt(8.0 * threshold) + 4 + law.band * threshold;
}

}  // namespace samples
