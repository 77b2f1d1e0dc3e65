// SPDX-License-Identifier: Apache-2.0
#include "sand/model/probe_point.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sand/model/height_field.hpp"
#include "sand/model/mean_height.hpp"
#include "tests/support/seed.hpp"

namespace {

using sand::HeightField;
using sand::probePoint;
using sand::ProbePoint;

constexpr double kProbe = sand::kProbePerCell;

TEST(ProbePoint, IsTheNearestWholeUnit) {
    EXPECT_EQ(probePoint(1, -2, 0.25), (ProbePoint{256, -512, 64}));
    EXPECT_EQ(probePoint(0.49 / kProbe, 0.51 / kProbe, -0.51 / kProbe), (ProbePoint{0, 1, -1}));
    EXPECT_EQ(probePoint(0.5 / kProbe, 1.5 / kProbe, -0.5 / kProbe), (ProbePoint{1, 2, 0})) << "half is rounded up";
}

TEST(ProbePoint, IsWithinTheRangeOfAStep) {
    const std::int32_t most = sand::kMaxProbe;
    EXPECT_EQ(probePoint(1e30, -1e30, most / kProbe), (ProbePoint{most - 1, -most, most - 1}));
    EXPECT_EQ(probePoint((most - 1.5) / kProbe, (most - 1.6) / kProbe, (0.4 - most) / kProbe),
              (ProbePoint{most - 1, most - 2, -most}));
}

TEST(ProbePoint, OfItsOwnPlaceIsTheSamePoint) {
    std::mt19937 random(test::randomSeed());
    for (int i = 0; i < 1000; ++i) {
        const auto number = [&] { return static_cast<std::int32_t>(random() % (2U << 24U)) - sand::kMaxProbe; };
        const ProbePoint probe{number(), number(), number()};
        EXPECT_EQ(probePoint(probe.x / kProbe, probe.y / kProbe, probe.z / kProbe), probe);
    }
}

/// Returns a field whose heights are 1000 · column + 30 · row [unit].
HeightField plane(int columns, int rows) {
    HeightField field(columns, rows, 0.5);
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            field.setHeight(column, row, 1000 * column + 30 * row);
        }
    }
    return field;
}

TEST(HeightField, IsInterpolatedBetweenTheCentresOfItsCells) {
    const HeightField field = plane(8, 5);
    const auto at = [&](double x, double y /* [cell] */) { return field.interpolated(x * kProbe, y * kProbe); };
    EXPECT_DOUBLE_EQ(at(3.5, 2.5), 3060) << "the centre of a cell";
    EXPECT_DOUBLE_EQ(at(4.25, 2.5), 3810);
    EXPECT_DOUBLE_EQ(at(4.25, 3), 3825);
    EXPECT_DOUBLE_EQ(at(0.2, 0.1), 0) << "beyond the outermost centres the height of the nearest one counts";
    EXPECT_DOUBLE_EQ(at(-1e30, 1e30), 120);
    EXPECT_DOUBLE_EQ(at(8, 2.5), 7060);
    EXPECT_DOUBLE_EQ(plane(1, 1).interpolated(40, 300), 0) << "one cell has one height";
}

TEST(MeanHeight, OfAPlaneIsThatOfTheMiddle) {
    const auto slope = [](double x, double y) { return 3 * x - 2 * y + 5; };
    EXPECT_DOUBLE_EQ(sand::meanHeight(slope, 100, 40, 64, 5), 225);
    EXPECT_DOUBLE_EQ(sand::meanHeight(slope, 100, 40, 64, 9), 225);
}

TEST(MeanHeight, CountsPlacesUpToTheRadius) {
    // Of the five columns of places in [-64, 64], those at -64 and 64 are at least 60 away: 10 of 25 places.
    const auto far = [](double x, double) { return std::abs(x) >= 60 ? 1.0 : 0.0; };
    EXPECT_DOUBLE_EQ(sand::meanHeight(far, 0, 0, 64, 5), 0.4);
    EXPECT_DOUBLE_EQ(sand::meanHeight(far, 0, 0, 59, 5), 0);
    const auto corner = [](double x, double y) { return x > 60 && y > 60 ? 1.0 : 0.0; };
    EXPECT_DOUBLE_EQ(sand::meanHeight(corner, 0, 0, 64, 9), 1.0 / 81);
}

}  // namespace
