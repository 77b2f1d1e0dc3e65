// SPDX-License-Identifier: Apache-2.0
// Commands that come while the sand thread is busy take a limited amount of memory.
#include "haptic_bridge/server/commands.hpp"

#include <algorithm>
#include <cstdio>
#include <future>
#include <memory>
#include <vector>

#include "haptic_bridge/devices/open_device.hpp"
#include "haptic_bridge/server/sand_thread.hpp"
#include "tests/support/machine/resident.hpp"
#include "tests/support/processes/server_process.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

using namespace haptic_bridge;

TEST(Commands, KeepTheLatestFramesAndTheLatestEdit) {
    Commands commands;
    EXPECT_TRUE(commands.empty());
    for (std::uint64_t step = 1; step <= 1'000; ++step) {
        commands.add(Commands::Frame{{step, 1}, 2});
        commands.add(EditRequest{sand::Edit::loaded(base::Bytes(60'000, static_cast<std::uint8_t>(step)))});
    }
    EXPECT_FALSE(commands.empty());
    ASSERT_EQ(commands.frames.size(), Commands::kMostFrames);
    EXPECT_EQ(commands.frames.back().shown.stepNumber, 1'000U);
    EXPECT_EQ(commands.edit->edit.sand->front(), static_cast<std::uint8_t>(1'000));
}

TEST(Commands, AReleaseRemovesTheCommandsOfItsMaster) {
    Commands commands;
    commands.add(Commands::Grant{1, {}});
    commands.add(CatchUp{});
    commands.add(State{base::Bytes(100, 1)});
    commands.add(Commands::Frame{});
    commands.add(EditRequest{sand::Edit::settle});
    commands.release();
    EXPECT_TRUE(commands.released);
    EXPECT_TRUE(!commands.grant && commands.catchUps.empty() && !commands.state && commands.frames.empty() &&
                !commands.edit);
    commands.add(Commands::Grant{2, {}});
    EXPECT_TRUE(commands.released) << "before the next master's grant";
    EXPECT_EQ(commands.grant->session, 2U);
}

/// A sand thread that is busy until the test lets it continue. It waits in the callback that asks for sand.
class BusySandThread {
public:
    BusySandThread()
        : hand_(scene_, openDevice("script:gis", HandSettings::parse({}), scene_), HandSettings::Datum::surface),
          thread_(sand::Replica(scene_), Pace::realtime, hand_, *channel_,
                  {[](std::uint32_t) {},
                   [this](std::uint32_t, NeedState) {
                       busy_.set_value();
                       goOn_.get_future().wait();
                   },
                   [](std::uint32_t, const std::string&) {}, [](std::uint32_t, const base::Bytes&, std::uint64_t) {}}) {
        thread_.start(1, {1, 7, 7});
        busy_.get_future().wait();
    }
    ~BusySandThread() { goOn_.set_value(); }
    BusySandThread(const BusySandThread&) = delete;
    BusySandThread& operator=(const BusySandThread&) = delete;

    [[nodiscard]] SandThread& thread() { return thread_; }

private:
    const scene::Scene scene_ = samples::flatScene(40, 40);
    std::promise<void> busy_, goOn_;
    std::unique_ptr<HandChannel> channel_ = std::make_unique<HandChannel>();
    HapticTick hand_;
    SandThread thread_;
};

// Each `settle` lets the server read another long load (docs/protocol.md).
TEST(SandThread, SixLoadsOf192MiBBetweenSettlesLeaveMemoryFlat) {
    BusySandThread busy;
    const std::int64_t before = residentBytes();
    std::int64_t most = 0;
    std::vector<std::weak_ptr<const base::Bytes>> loads;
    std::ptrdiff_t alive = 0;
    for (int i = 0; i < 6; ++i) {
        EditRequest load{sand::Edit::loaded(base::Bytes(sand::kMaxSandBytes, static_cast<std::uint8_t>(i + 1)))};
        loads.emplace_back(load.edit.sand);
        busy.thread().edit(std::move(load));
        alive =
            std::max(alive, std::count_if(loads.begin(), loads.end(), [](const auto& one) { return !one.expired(); }));
        most = std::max(most, residentBytes() - before);
        busy.thread().edit({sand::Edit::settle});
    }
    EXPECT_EQ(alive, 1);
    std::printf("resident memory grew by %.0f MiB at most\n", static_cast<double>(most) / (1 << 20));
#ifdef SANDWALL_RELEASE  // sanitizers keep memory that was freed
    // One load waits while the next one replaces it.
    EXPECT_LT(most, static_cast<std::int64_t>(3 * sand::kMaxSandBytes));
#endif
}

TEST(SandThread, ManyFramesAndSmallLoadsLeaveMemoryFlat) {
    BusySandThread busy;
    const std::int64_t before = residentBytes();
    const EditRequest small{sand::Edit::loaded(base::Bytes(60'000, 1))};
    for (std::uint64_t i = 0; i < 200'000; ++i) {
        busy.thread().shown({i, 1}, 1);
        if (i % 100 == 0) {
            busy.thread().edit({sand::Edit::loaded(base::Bytes(60'000, 1))});
        }
    }
    const double grown = static_cast<double>(residentBytes() - before);
    std::printf("resident memory grew by %.0f MiB\n", grown / (1 << 20));
#ifdef SANDWALL_RELEASE
    // One small load and 64 frames take 62 KB; the allocator may keep some pages more.
    EXPECT_LT(grown, 8.0 * (1 << 20));
#endif
}

}  // namespace
