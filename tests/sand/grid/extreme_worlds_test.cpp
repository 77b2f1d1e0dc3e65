// SPDX-License-Identifier: Apache-2.0
// Every extreme world comes to rest within its bound and keeps its volume. The report shows the same worlds.
#include "tests/support/sand/extreme_worlds.hpp"

#include <gtest/gtest.h>

#include "tests/support/sand/relaxing.hpp"

namespace {

TEST(ExtremeWorlds, RestWithinTheirBoundsAndKeepTheirVolume) {
    for (const samples::Law& law : samples::laws()) {
        for (const extremes::World& world : extremes::worlds(law)) {
            if (samples::kSanitized && world.slow && !law.inertial()) {
                continue;  // takes ten times the sweeps without inertia
            }
            const extremes::Outcome outcome = extremes::relax(world);
            EXPECT_TRUE(outcome.settled) << world.name << ", " << nameOf(law);
            EXPECT_EQ(outcome.lost, 0) << world.name << ", " << nameOf(law);
            EXPECT_LE(outcome.excess, world.bound) << world.name << ", " << nameOf(law);
            EXPECT_EQ(outcome.moved == 0, world.stays) << world.name << ", " << nameOf(law);
            const samples::Extremes start = samples::extremesOf(world.field);
            EXPECT_LE(outcome.rest.highest, start.highest) << world.name << ", " << nameOf(law);
            EXPECT_GE(outcome.rest.lowest,
                      world.rules.rim == sand::Rim::open ? std::min(start.lowest, 0) : start.lowest)
                << world.name << ", " << nameOf(law);
            EXPECT_EQ(outcome.outflow > 0, world.rules.rim == sand::Rim::open) << world.name << ", " << nameOf(law);
        }
    }
}

}  // namespace
