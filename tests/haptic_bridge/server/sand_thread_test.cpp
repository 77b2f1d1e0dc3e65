// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/server/sand_thread.hpp"

#include "haptic_bridge/devices/open_device.hpp"
#include "scene/load/scene_file.hpp"
#include "tests/haptic_bridge/server/server_process.hpp"

namespace {

using namespace haptic_bridge;
using namespace test;

// A wall that keeps the server waiting holds the sand still; what the hand feels of it is as it is, and not out of
// date.
TEST(SandThread, WhatIsFeltDoesNotAgeWhileStepsAreWithheld) {
    const Folder folder;
    const scene::Scene scene = scene::loadScene(folder.write("small.toml", kSmallScene));
    HapticTick hand(scene, openDevice("script:gis", HandSettings::parse({}), scene), HandSettings::Datum::surface);
    HandChannel channel;
    SandThread sandThread(scene, Pace::realtime, hand, channel,
                          {[](std::uint32_t) {}, [](std::uint32_t, NeedState) {},
                           [](std::uint32_t, const std::string&) {}, [](std::uint32_t, const base::Bytes&) {}});
    sandThread.start(1, {1, 0, sand::Replica(scene).stateHash()});
    const auto withheld = [&](std::uint64_t steps) {
        return eventually([&] { return sandThread.withheld() >= steps; });
    };
    ASSERT_TRUE(withheld(2)) << "nothing is shown";
    ASSERT_TRUE(eventually([&] { return channel.surface.latest().step == SandThread::kWindow; }));
    const std::int64_t before = channel.surface.latest().timeNs;
    ASSERT_TRUE(withheld(sandThread.withheld() + 3));
    EXPECT_GT(channel.surface.latest().timeNs, before);
    EXPECT_EQ(channel.surface.latest().step, SandThread::kWindow);
}

}  // namespace
