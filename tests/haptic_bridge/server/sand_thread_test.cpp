// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/server/sand_thread.hpp"

#include <mutex>

#include "haptic_bridge/devices/open_device.hpp"
#include "host/clock.hpp"
#include "scene/load/scene_file.hpp"
#include "tests/support/hand/arm_on_sand.hpp"
#include "tests/support/processes/server_process.hpp"

namespace {

using namespace haptic_bridge;
using namespace test;

/// A hand at a place that the test sets, half a radius deep in the sand as the session began.
class StandingHand : public Device {
public:
    explicit StandingHand(const std::atomic<double>& east) : east_(east) {}
    [[nodiscard]] Pose read(double) override { return {east_, 0, 0.5, true}; }
    void sendForce(Vec3) override {}
    [[nodiscard]] bool finished(double) const override { return false; }

private:
    const std::atomic<double>& east_;
};

/// A sand thread whose wall shows no step, and the messages that it has sent.
class Server {
public:
    Server(const scene::Scene& scene, Pace pace, std::unique_ptr<Device> device)
        : replica_(scene),
          hand_(scene, std::move(device), HandSettings::Datum::surface, Guards::Mode::literal),
          thread_(replica_, pace, hand_, *channel_,
                  {[](std::uint32_t) {}, [](std::uint32_t, NeedState) {}, [](std::uint32_t, const std::string&) {},
                   [this](std::uint32_t, const base::Bytes& message, std::uint64_t) { take(message); }}) {}

    /// Links a master whose sand is that of all steps so far.
    void link() {
        ++epoch_;
        thread_.start(epoch_, {epoch_, replica_.stepNumber(), replica_.stateHash()});
    }
    [[nodiscard]] bool made(std::size_t steps) {
        return eventually([&] { return ticks().size() >= steps; });
    }
    /// The last tick before each step that was made.
    [[nodiscard]] std::vector<Tick> ticks() {
        const std::lock_guard lock(mutex_);
        return ticks_;
    }
    [[nodiscard]] SandThread& thread() { return thread_; }
    [[nodiscard]] HandChannel& channel() { return *channel_; }
    [[nodiscard]] HapticTick& hand() { return hand_; }

private:
    void take(const base::Bytes& message) {
        constexpr std::size_t kLength = sizeof(std::uint32_t);
        const std::lock_guard lock(mutex_);
        replica_.apply(std::get<StepMessage>(decode(std::span(message).subspan(kLength))).step);
        ticks_.push_back(hand_.lastTick());
    }

    std::mutex mutex_;
    std::vector<Tick> ticks_;
    sand::Replica replica_;
    std::uint32_t epoch_ = 0;
    std::unique_ptr<HandChannel> channel_ = std::make_unique<HandChannel>();
    HapticTick hand_;
    SandThread thread_;
};

/// The field and the tool of Dorjgotov et al. 2007, of 2.5 cells. West of x = -0.3 the sand is 0.02 higher.
scene::Scene terraced() {
    scene::Scene scene = levelSand({}, 500);
    for (int row = 0; row < 500; ++row) {
        for (int column = 0; column < 175; ++column) {
            scene.terrain.setHeight(column, row, 5 * sand::kUnitsPerCell);
        }
    }
    return scene;
}
/// The terrace sand, a hand over it, and a server that is not linked yet.
struct Terrace {
    Terrace(Pace pace, double place) : east(place), server(scene, pace, std::make_unique<StandingHand>(east)) {}

    const scene::Scene scene = terraced();
    std::atomic<double> east;  // [hand space], x of the hand
    Server server;
};
constexpr double kWest = -0.6, kEast = 0.2;  // in hand space: on the terrace, and far below it

// At half a radius the law of Dorjgotov et al. 2007 gives 1000 (e^0.0025 - 1) = 2.503128 N, and heights are floats.
// On the sand around cell (0, 0), which is as high as the terrace, it would be 1000 (e^0.0125 - 1) = 12.6 N.
constexpr double kHalfRadius = 2.503128, kFloat = 1e-4;  // [N]

TEST(SandThread, TheFirstSurfaceIsTheSandUnderTheHand) {
    Terrace terrace(Pace::fast, kEast);
    Server& server = terrace.server;
    server.link();
    ASSERT_TRUE(server.made(1));
    const Tick first = server.ticks().front();
    EXPECT_EQ(first.surfaceStep, 0U) << "the sand was felt before the first step";
    EXPECT_NEAR(first.sent.z, kHalfRadius, kFloat);
}

// The tool was left in the sand where the hand was. The first step of the next link lifts it there.
TEST(SandThread, TheFirstSurfaceOfTheNextLinkIsTheSandUnderTheHandThen) {
    Terrace terrace(Pace::fast, kEast);
    Server& server = terrace.server;
    server.link();
    ASSERT_TRUE(server.made(8));
    server.thread().release();
    terrace.east = kWest;
    server.link();
    ASSERT_TRUE(server.made(10));
    const Tick next = server.ticks()[9];
    EXPECT_EQ(next.surfaceStep, 9U) << "the ninth step lifts the tool and holds no ticks";
    EXPECT_NEAR(next.sent.z, kHalfRadius, kFloat);
}

TEST(SandThread, InRealTimeTheFirstSurfaceIsTheSandWhereTheHandRests) {
    Terrace terrace(Pace::realtime, kWest);
    Server& server = terrace.server;
    server.hand().rest(0);  // as the force loop does at 1 kHz while no master is linked
    server.link();
    ASSERT_TRUE(eventually([&] { return !server.channel().surface.latest().patch.empty(); }));
    const FeltSand& surface = server.channel().surface.latest();
    EXPECT_NEAR(surface.patch.height(1 + kWest, 1), 0.02, 1e-6);
    // 11 cells on each side of the hand and no more, because the whole field would also contain the other place.
    EXPECT_EQ(surface.probe, (sand::ProbePoint{100 * sand::kProbePerCell, 250 * sand::kProbePerCell, 0}));
}

// The window is 8 steps (docs/protocol.md).
TEST(SandThread, IsAtMostEightStepsAheadOfTheWall) {
    Terrace terrace(Pace::realtime, kEast);
    Server& server = terrace.server;
    server.link();
    // A withheld step was due while the wall was a whole window behind.
    const auto withheld = [&](std::uint64_t steps) {
        return eventually([&] { return inAll(server.thread().withheld()) >= steps; });
    };
    ASSERT_TRUE(withheld(2));
    EXPECT_EQ(server.ticks().size(), 8U);
    server.thread().shown({3, 16'666'667}, host::monotonicNs());
    ASSERT_TRUE(server.made(11));
    ASSERT_TRUE(withheld(inAll(server.thread().withheld()) + 2));
    EXPECT_EQ(server.ticks().size(), 11U);
}

// A wall that keeps the server waiting stops the sand. The hand still feels that sand, and it does not count as stale.
TEST(SandThread, WhatIsFeltDoesNotAgeWhileStepsAreWithheld) {
    const Folder folder;
    const scene::Scene scene = scene::loadScene(folder.write("small.toml", kSmallScene));
    HapticTick hand(scene, openDevice("script:gis", HandSettings::parse({}), scene), HandSettings::Datum::surface);
    HandChannel channel;
    SandThread sandThread(
        sand::Replica(scene), Pace::realtime, hand, channel,
        {[](std::uint32_t) {}, [](std::uint32_t, NeedState) {}, [](std::uint32_t, const std::string&) {},
         [](std::uint32_t, const base::Bytes&, std::uint64_t) {}});
    sandThread.start(1, {1, 0, sand::Replica(scene).stateHash()});
    const auto withheld = [&](std::uint64_t steps) {
        return eventually([&] { return inAll(sandThread.withheld()) >= steps; });
    };
    ASSERT_TRUE(withheld(2)) << "the wall shows no step";
    ASSERT_TRUE(eventually([&] { return channel.surface.latest().step == StepMaker::kWindow; }));
    const std::int64_t before = channel.surface.latest().timeNs;
    ASSERT_TRUE(withheld(inAll(sandThread.withheld()) + 3));
    EXPECT_GT(channel.surface.latest().timeNs, before);
    EXPECT_EQ(channel.surface.latest().step, StepMaker::kWindow);
}

}  // namespace
