// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/refine/simplify.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "sand/grid/dunes.hpp"

namespace {

using sand::tin::LatticePoint;
using sand::tin::Raster;
using sand::tin::Simplified;
using sand::tin::simplify;

constexpr int kColumns = 70, kRows = 50;
constexpr std::int32_t kWidth = kColumns * 256, kDepth = kRows * 256;

std::vector<double> dunes() {
    sand::HeightField field(kColumns, kRows, 0.05);
    sand::grid::makeDunes({.height = 0.2, .length = 0.9}, field);
    std::vector<double> heights;
    for (int y = 0; y < kRows; ++y) {
        for (int x = 0; x < kColumns; ++x) {
            heights.push_back(field.height(x, y) * field.unit());
        }
    }
    return heights;
}

/// Returns a raster with samples at the cell centres.
Raster rasterOf(const std::vector<double>& heights) { return {heights, kColumns, kRows, {128, 128}}; }

/// Returns the vertical errors of all samples with data. Locates each sample, in contrast to simplify(), which scans
/// triangles.
std::vector<double> errorsOf(const Simplified& tin, const Raster& raster) {
    sand::tin::Mesh mesh(kWidth, kDepth);
    for (std::size_t i = 0; i < tin.places.size(); ++i) {
        EXPECT_EQ(mesh.insert(tin.places[i]), static_cast<sand::tin::Vertex>(i));
    }
    std::vector<double> errors;
    for (std::size_t i = 0; i < raster.heights.size(); ++i) {
        if (std::isnan(raster.heights[i])) {
            continue;
        }
        const auto found = sand::tin::locate(mesh.triangles(), raster.placeOf(i), sand::tin::kNoNumber);
        const auto& triangle = mesh.triangles().triangles[static_cast<std::size_t>(found.triangle)];
        double sum = 0, area = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto weight = static_cast<double>(found.weights[k]);
            sum += weight * tin.heights[static_cast<std::size_t>(triangle.corner[k])];
            area += weight;
        }
        errors.push_back(std::abs(raster.heights[i] - sum / area));
    }
    return errors;
}

TEST(Simplify, MeetsItsErrorAtEverySample) {
    const std::vector<double> heights = dunes();
    for (const double error : {0.05, 0.01, 0.002}) {
        const Simplified tin = simplify(kWidth, kDepth, rasterOf(heights), {error});
        const std::vector<double> errors = errorsOf(tin, rasterOf(heights));
        const double largest = *std::max_element(errors.begin(), errors.end());
        const double squares = std::inner_product(errors.begin(), errors.end(), errors.begin(), 0.0);
        EXPECT_LE(largest, error * (1 + 1e-12));
        EXPECT_NEAR(tin.maxError, largest, 1e-12);
        EXPECT_NEAR(tin.rmsError, std::sqrt(squares / static_cast<double>(errors.size())), 1e-12);
        EXPECT_LT(tin.places.size(), heights.size());
    }
}

TEST(Simplify, IsTheSameTwiceAndAShorterRunIsTheBeginningOfALongerOne) {
    const std::vector<double> heights = dunes();
    const Simplified one = simplify(kWidth, kDepth, rasterOf(heights), {0.004});
    const Simplified two = simplify(kWidth, kDepth, rasterOf(heights), {0.004});
    EXPECT_EQ(one.places, two.places);
    EXPECT_EQ(one.heights, two.heights);
    const Simplified few = simplify(kWidth, kDepth, rasterOf(heights), {0, 60});
    ASSERT_EQ(few.places.size(), 60U);
    EXPECT_TRUE(std::equal(few.places.begin(), few.places.end(), one.places.begin()));
    EXPECT_GT(few.maxError, one.maxError);
}

TEST(Simplify, WithoutAnErrorItEndsWithEverySample) {
    std::vector<double> heights = dunes();
    const Simplified tin = simplify(kWidth, kDepth, rasterOf(heights), {0});
    EXPECT_LE(tin.maxError, 1e-15);
    EXPECT_LE(tin.places.size(), heights.size() + 4);
    std::vector<LatticePoint> places = tin.places;
    std::sort(places.begin(), places.end());
    EXPECT_EQ(std::adjacent_find(places.begin(), places.end()), places.end());
}

TEST(Simplify, APlaneNeedsNothingButTheCorners) {
    std::vector<double> heights;
    for (int y = 0; y < 5; ++y) {
        for (int x = 0; x < 9; ++x) {
            heights.push_back(0.5 * x - 0.25 * y + 1);
        }
    }
    const Raster raster{heights, 9, 5, {0, 0}, {256, 512}};  // samples on the rim; rows twice as far apart
    const Simplified tin = simplify(8 * 256, 4 * 512, raster, {1e-12});
    EXPECT_EQ(tin.places.size(), 4U);
    EXPECT_LE(tin.maxError, 1e-12);
}

TEST(Simplify, SamplesWithoutDataCountForNothing) {
    std::vector<double> heights = dunes();
    const auto inHole = [](int x, int y) { return (x > 20 && x < 40 && y > 10 && y < 33) || (x < 4 && y < 4); };
    for (int y = 0; y < kRows; ++y) {
        for (int x = 0; x < kColumns; ++x) {
            if (inHole(x, y)) {
                heights[static_cast<std::size_t>(y * kColumns + x)] = std::numeric_limits<double>::quiet_NaN();
            }
        }
    }
    const Simplified tin = simplify(kWidth, kDepth, rasterOf(heights), {0.005});
    const std::vector<double> errors = errorsOf(tin, rasterOf(heights));
    EXPECT_LE(*std::max_element(errors.begin(), errors.end()), 0.005 * (1 + 1e-12));
    for (std::size_t i = 0; i < tin.places.size(); ++i) {
        EXPECT_TRUE(std::isfinite(tin.heights[i]));
        EXPECT_TRUE(i < 4 || !inHole(tin.places[i].x / 256, tin.places[i].y / 256));
    }
    EXPECT_EQ(tin.heights[0], heights[4]);  // the height of the nearest sample with data, of two the first
}

TEST(Simplify, NeedsFewerPointsThanARegularGrid) {
    const std::vector<double> heights = dunes();
    std::vector<LatticePoint> places;
    std::vector<double> chosen;
    for (std::size_t y = 0; y < kRows; y += 3) {
        for (std::size_t x = 0; x < kColumns; x += 3) {
            places.push_back(rasterOf(heights).placeOf(y * kColumns + x));
            chosen.push_back(heights[y * kColumns + x]);
        }
    }
    const Simplified grid = sand::tin::measured(kWidth, kDepth, rasterOf(heights), places, chosen);
    EXPECT_EQ(grid.places.size(), places.size() + 4);
    const Simplified tin = simplify(kWidth, kDepth, rasterOf(heights), {0, static_cast<int>(grid.places.size())});
    EXPECT_LT(tin.maxError, grid.maxError / 2);
    EXPECT_LT(tin.rmsError, grid.rmsError);
}

TEST(Simplify, RefusesWhatIsNoRasterOfTheField) {
    std::vector<double> heights(12, 1.0);
    const auto refuses = [&](const Raster& raster, int maxVertices = 100) {
        EXPECT_THROW(static_cast<void>(simplify(1024, 1024, raster, {0, maxVertices})), std::invalid_argument);
    };
    refuses({heights, 4, 4, {0, 0}});
    refuses({heights, 4, 3, {300, 0}});
    refuses({heights, 4, 3, {-1, 0}});
    refuses({heights, 4, 3, {0, 0}, {0, 256}});
    refuses({{}, 0, 0, {0, 0}});
    refuses({heights, 4, 3, {0, 0}}, 3);
    EXPECT_EQ(simplify(1024, 1024, {heights, 4, 3, {0, 0}}, {}).places.size(), 4U);
    heights[5] = std::numeric_limits<double>::infinity();
    refuses({heights, 4, 3, {0, 0}});
    std::fill(heights.begin(), heights.end(), std::nan(""));
    refuses({heights, 4, 3, {0, 0}});
}

}  // namespace
