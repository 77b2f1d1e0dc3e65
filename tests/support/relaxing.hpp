// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "sand/grid/erosion.hpp"
#include "scene/material.hpp"

/// Letting fields slide to rest, for tests of the solver.
namespace samples {

/// The address sanitizer makes a sweep some twenty times dearer: there the largest grids are left out, and what they
/// show is shown by the other builds.
#ifdef __SANITIZE_ADDRESS__
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

/// Ten times as slow as a release build: tests then run fewer of many alike.
#ifdef __OPTIMIZE__
inline constexpr bool kSlowBuild = kSanitized;
#else
inline constexpr bool kSlowBuild = true;
#endif

/// Every scheme, the default first.
inline constexpr auto kSchemes = [] {
    std::array<sand::Scheme, sand::kSchemes.size()> schemes{};
    std::ranges::transform(sand::kSchemes, schemes.begin(), &sand::NamedScheme::scheme);
    return schemes;
}();

/// The band of scenes that name none.
inline constexpr double kDefaultBand = scene::Material{}.band;

/// A scheme and a band: what decides how sand slides. Converts from a scheme alone, without a band.
struct Law {
    sand::Scheme scheme = sand::Scheme::isotropic;
    double band = 0;  // share of the threshold beyond which sand at rest starts to slide

    Law() = default;
    Law(sand::Scheme of, double width = 0) : scheme(of), band(width) {}  // NOLINT(google-explicit-constructor)
    [[nodiscard]] bool inertial() const { return scheme == sand::Scheme::isotropic; }
    friend auto operator<=>(const Law&, const Law&) = default;
};

/// Every scheme without a band and with the default one.
inline std::vector<Law> laws() {
    std::vector<Law> all;
    for (const sand::Scheme scheme : kSchemes) {
        all.insert(all.end(), {{scheme}, {scheme, kDefaultBand}});
    }
    return all;
}

inline std::string nameOf(const Law& law) {
    const auto* const known = std::ranges::find(sand::kSchemes, law.scheme, &sand::NamedScheme::scheme);
    return fmt::format("scheme {}, band {}", known->name, law.band);
}

/// Rules for a field alone: closed rim, square cells; 45 degrees and no band unless said.
inline sand::Rules rulesFor(const sand::HeightField& field, const Law& law = {},
                            std::int32_t threshold = sand::kUnitsPerCell) {
    sand::Rules rules;
    rules.columns = field.columns();
    rules.rows = field.rows();
    rules.threshold = threshold;
    rules.startThreshold = threshold + static_cast<std::int32_t>(law.band * threshold);
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

/// Sweeps until nothing moves, and expects that the volume is kept and no new extreme arises, which holds for any
/// field in a closed box. Returns the number of sweeps.
inline std::int64_t relax(sand::HeightField& field, const sand::Rules& rules, int most = 1000000) {
    const std::int64_t volume = field.volume();
    const Extremes before = extremesOf(field);
    sand::grid::Erosion erosion(field, rules);
    const std::int64_t outflow = erosion.sweep(field, most);
    EXPECT_TRUE(erosion.settled()) << nameOf(Law(rules.scheme)) << " still moves after " << most << " sweeps";
    EXPECT_EQ(field.volume() + outflow, volume);
    const Extremes after = extremesOf(field);
    EXPECT_GE(after.lowest, rules.rim == sand::Rim::open ? std::min(before.lowest, 0) : before.lowest);
    EXPECT_LE(after.highest, before.highest);
    return erosion.sweepsDone();
}

/// Slope m at the steepest face of a field of square cells, as scheme G measures it, less the threshold [unit].
inline double steepestExcess(const sand::HeightField& field, std::int32_t threshold) {
    const int columns = field.columns();
    const int rows = field.rows();
    // Beyond the rim the ground goes on as it came.
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

/// How far above the threshold a face may be at rest [unit]: a flux below one unit moves nothing, and sand that never
/// slid rests up to the start threshold.
inline double restingExcess(std::int32_t threshold, const Law& law = {}) {
    return std::cbrt(8.0 * threshold) + 4 + law.band * threshold;
}

}  // namespace samples
