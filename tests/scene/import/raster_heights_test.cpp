// SPDX-License-Identifier: Apache-2.0
#include "scene/import/raster_heights.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace {

using scene::NumberSize;
using scene::RasterHeights;

RasterHeights heightsOf(const std::vector<double>& numbers, NumberSize size) {
    RasterHeights heights(size);
    heights.reserve(numbers.size());
    for (const double number : numbers) {
        heights.add(number);
    }
    return heights;
}

std::vector<double> listOf(const RasterHeights& heights) { return {heights.begin(), heights.end()}; }

// A height that is computed in floats would differ from the seventh digit on.
TEST(RasterHeights, OfFloatsAreThoseOfDoublesBitForBit) {
    std::vector<double> numbers;
    for (int number = -32768; number <= 65535; number += 7) {
        numbers.push_back(number);
    }
    numbers.insert(numbers.end(), {-0.0, double{0.1F}, double{-3.3333333F}, double{1e-40F}});
    RasterHeights floats = heightsOf(numbers, NumberSize::floats);
    for (const auto& [factor, summand, divisor] : {std::array{0.1, 5.0, 0.3048}, std::array{-3.7, 0.0, 1.0}}) {
        floats.multiply(factor, summand);
        floats.divide(divisor);
        for (double& number : numbers) {
            number = (number * factor + summand) / divisor;
        }
    }
    ASSERT_EQ(floats.size(), numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        ASSERT_EQ(std::bit_cast<std::uint64_t>(floats[i]), std::bit_cast<std::uint64_t>(numbers[i])) << i;
    }
}

TEST(RasterHeights, KeepTheSignOfZeroAndNoData) {
    RasterHeights heights = heightsOf({-0.0, std::nan("")}, NumberSize::floats);
    heights.divide(1);
    heights.divide(2);
    EXPECT_TRUE(std::signbit(heights[0]));
    EXPECT_TRUE(std::isnan(heights[1]));
}

TEST(RasterHeights, TakeAsManyBytesAsTheirNumbersNeed) {
    EXPECT_EQ(scene::bytesOf(NumberSize::floats), 4);
    EXPECT_EQ(scene::bytesOf(NumberSize::doubles), 8);
    const double fine = 1 + std::numeric_limits<double>::epsilon();
    EXPECT_EQ(heightsOf({fine}, NumberSize::doubles)[0], fine);
}

TEST(RasterHeights, KeepAPart) {
    for (const NumberSize size : {NumberSize::floats, NumberSize::doubles}) {
        const std::vector<double> all{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};  // 4 columns, 3 rows
        RasterHeights heights = heightsOf(all, size);
        heights.keepPart(4, {0, 0, 4, 3});
        EXPECT_EQ(listOf(heights), all);
        heights.keepPart(4, {1, 1, 3, 3});
        EXPECT_EQ(listOf(heights), (std::vector<double>{6, 7, 10, 11}));
        heights.keepPart(2, {0, 0, 1, 2});
        EXPECT_EQ(listOf(heights), (std::vector<double>{6, 10}));
    }
}

TEST(RasterHeights, TurnOver) {
    for (const NumberSize size : {NumberSize::floats, NumberSize::doubles}) {
        RasterHeights odd = heightsOf({1, 2, 3, 4, 5, 6}, size);
        odd.turnOver(2);
        EXPECT_EQ(listOf(odd), (std::vector<double>{5, 6, 3, 4, 1, 2}));
        odd.turnOver(3);
        EXPECT_EQ(listOf(odd), (std::vector<double>{4, 1, 2, 5, 6, 3}));
    }
}

}  // namespace
