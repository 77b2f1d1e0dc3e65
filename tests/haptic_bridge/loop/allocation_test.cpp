// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <memory>

#include "haptic_bridge/server/sand_thread.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/hand/arm_on_sand.hpp"
#include "tests/support/machine/heap_count.hpp"

namespace {

using namespace haptic_bridge;

TEST(ForceTick, AsksForNoMemory) {
    const scene::Scene scene = test::levelSand();
    test::ArmSession session(
        scene, std::make_unique<SimulatedArm>(touchPreset(), Grip{300, 5}, test::toAndFro(0.002, 0.3, 0.5)));
    const auto channel = std::make_unique<HandChannel>();
    (void)session.tick();
    const long before = test::heapRequests();
    for (int tick = 0; tick < 1500; ++tick) {
        (void)session.tick(tick == 0 || tick == 700 ? 0.1 : 0);  // faults; a third one would switch the force off
        (void)channel->samples.push(session.sample());
        (void)channel->surface.latest();
    }
    EXPECT_EQ(test::heapRequests() - before, 0);
    EXPECT_GT(norm(session.hand().lastTick().sent), 0) << "the ticks were in the sand";
    const auto some = std::make_unique<SimulatedArm>(touchPreset());
    EXPECT_GT(test::heapRequests() - before, 0) << "the count notices an allocation";
}

}  // namespace
