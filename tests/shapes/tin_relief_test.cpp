// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <random>

#include "shapes/tin/relief.hpp"

namespace {

TEST(TinRelief, TellsTheSameHeightWhereNothingIsBeyondTheField) {
    shapes::TinRelief relief(20 * 256, 16 * 256);
    std::mt19937 random(5);
    const auto corner = [&](std::int32_t x, std::int32_t y) {
        return shapes::ReliefCorner{{x * 256, y * 256}, static_cast<double>(random() % 100000)};
    };
    for (int y = 0; y < 16; y += 2) {
        for (int x = 0; x < 20; x += 2) {
            const auto a = corner(x, y), b = corner(x + 2, y), c = corner(x + 2, y + 2), d = corner(x, y + 2);
            relief.put({a, b, c});
            relief.put({a, c, d});
        }
    }
    constexpr int kReach = 3;
    int within = 0, beyond = 0;
    for (int i = 0; i < 2000; ++i) {
        const auto place = shapes::TinRelief::between(static_cast<std::int32_t>(random() % (20 * 256)),
                                                      static_cast<std::int32_t>(random() % (16 * 256)));
        const bool isWithin = relief.isWithin(place, kReach);
        (isWithin ? within : beyond) += 1;
        for (int north = -kReach; isWithin && north <= kReach; ++north) {
            for (int east = -kReach; east <= kReach; ++east) {
                ASSERT_EQ(relief.within(place, east, north), relief.at(place, east, north)) << "seed 5, " << i;
            }
        }
    }
    EXPECT_GT(within, 200);
    EXPECT_GT(beyond, 200);
}

}  // namespace
