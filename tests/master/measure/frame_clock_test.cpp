// SPDX-License-Identifier: Apache-2.0
// The begin of frames with a clock that the test moves, and a simulated monitor.
#include "master/measure/frame_clock.hpp"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <map>

#include "render_node/gl/swap_sync.hpp"
#include "walls/wall.hpp"

namespace {

using master::FrameClock;

constexpr std::int64_t kOneSecond = 1'000'000'000;       // [ns]
constexpr std::int64_t kSessionStart = 77 * kOneSecond;  // [ns], begin of a session, on a clock that began long before

double refreshOf(const char* wall) {
    return walls::loadWall(std::filesystem::path(SANDWALL_SOURCE_DIR "/walls/configs") / wall).refreshHz;
}

/// Number of frames that show each eye, left (0) and right (1).
using ByEye = std::array<int, 2>;

/// Counts the frames that begin within a second. Each takes `draws` [ns] to draw.
ByEye framesOfASecond(FrameClock clock, std::int64_t draws) {
    ByEye frames{};
    std::int64_t now = kSessionStart;
    for (std::uint64_t frame = 0;; ++frame) {
        now += clock.begin(now);
        if (now >= kSessionStart + kOneSecond) {
            return frames;
        }
        ++frames.at(frame % 2);
        now += draws;
    }
}

// As docs/stereo.md says, `refresh` is the number of frames per second. 120 gives each eye 60 pictures.
TEST(FrameClock, At120HertzGivesEachEye60PicturesASecond) {
    for (const char* wall : {"flex_cave.toml", "fish_tank.toml"}) {
        ASSERT_EQ(refreshOf(wall), 120) << wall;
        for (const std::int64_t draws : {0, 3'000'000, 8'000'000}) {  // [ns], all less than 1/120 s
            // The first frame is due at once. One more frame may begin at the end of the second, because of rounding.
            const ByEye frames = framesOfASecond(FrameClock(refreshOf(wall)), draws);
            EXPECT_NEAR(frames[0], 60, 1) << wall << ", drawing takes " << draws << " ns";
            EXPECT_NEAR(frames[1], 60, 1) << wall << ", drawing takes " << draws << " ns";
        }
    }
    EXPECT_NEAR(framesOfASecond(FrameClock(60), 0)[0], 30, 1) << "half of the wall's rate, whatever it is";
}

TEST(FrameClock, KeepsItsGridWhenAFrameIsLate) {
    FrameClock clock(100);
    std::int64_t now = kSessionStart;
    EXPECT_EQ(clock.begin(now), 0) << "the first frame is due";
    const std::int64_t first = clock.next();
    now = first + 4'000'000;  // late by less than a period
    EXPECT_EQ(clock.begin(now), 0);
    EXPECT_EQ(clock.next(), first + 10'000'000) << "the next frame is not late";
    now = first + 95'000'000;  // late by more than nine periods
    EXPECT_EQ(clock.begin(now), 0);
    EXPECT_EQ(clock.next(), now) << "lost time is not made up for";
    EXPECT_EQ(clock.begin(now), 0);
    EXPECT_EQ(clock.begin(now + 1'000'000), 9'000'000);
}

TEST(FrameClock, OfAFastSessionWaitsOnlyWhileNoStepsAreTaken) {
    FrameClock clock(100, haptic_bridge::Pace::fast);
    EXPECT_EQ(clock.begin(kSessionStart), 0);
    EXPECT_EQ(clock.next(), 0) << "the next frame is due at once";
    EXPECT_EQ(clock.begin(kSessionStart, true), 0) << "the first frame of a grid is due";
    EXPECT_EQ(clock.next(true), kSessionStart);
    EXPECT_EQ(clock.begin(kSessionStart + 1'000'000, true), 0);
    EXPECT_EQ(clock.begin(kSessionStart + 2'000'000, true), 8'000'000);
    EXPECT_EQ(clock.next(), 0) << "steps are taken again";
    EXPECT_EQ(clock.begin(kSessionStart), 0);
}

TEST(FrameClock, KnowsItsSwaps) {
    FrameClock clock(100);
    EXPECT_EQ(clock.lastSwap(), 0);
    EXPECT_EQ(clock.sinceSwap(kSessionStart), 0) << "there was no swap";
    EXPECT_EQ(clock.timeOf(1, kSessionStart), 0);
    const master::Swap first = clock.swapped(kSessionStart);
    EXPECT_TRUE(first.first);
    EXPECT_EQ(first.interval, 0);
    const master::Swap second = clock.swapped(kSessionStart + 12'000'000);
    EXPECT_FALSE(second.first);
    EXPECT_EQ(second.interval, 12'000'000);
    EXPECT_DOUBLE_EQ(second.milliseconds(), 12);
    EXPECT_DOUBLE_EQ(clock.seconds(), 0.012);
    EXPECT_DOUBLE_EQ(clock.sinceSwap(kSessionStart + 15'000'000), 0.003);
    EXPECT_DOUBLE_EQ(clock.timeOf(2, kSessionStart + 15'000'000), 0.015) << "since the first swap";
}

TEST(FrameClock, CountsTheTimeOfAFastSessionInFrames) {
    const FrameClock clock(120, haptic_bridge::Pace::fast);
    EXPECT_EQ(clock.timeOf(0), 0);
    EXPECT_DOUBLE_EQ(clock.timeOf(30), 0.25);
    EXPECT_DOUBLE_EQ(clock.period(), 1.0 / 120);
}

/// A monitor that counts its retraces and the frames that it shows. It is global, because GLX's functions are plain
/// pointers.
struct Monitor {
    double hertz = 120;
    std::int64_t now = kSessionStart;             // [ns]
    std::map<std::int64_t, std::uint64_t> shown;  // the frame that each retrace began to show
    std::uint64_t frame = 0;                      // frame that is being swapped

    [[nodiscard]] std::int64_t retraces() const {
        return static_cast<std::int64_t>(static_cast<double>(now) * 1e-9 * hertz);
    }
};
Monitor monitor;

int retracesOf(void* /* display */, render_node::GlxDrawable /* window */, std::int64_t* ust, std::int64_t* msc,
               std::int64_t* sbc) {
    *ust = *sbc = 0;
    *msc = monitor.retraces();
    return 1;
}

/// Waits for the next retrace with the remainder, as the specification of GLX_OML_sync_control says.
std::int64_t swapAtRetrace(void* /* display */, render_node::GlxDrawable /* window */, std::int64_t /* target */,
                           std::int64_t divisor, std::int64_t remainder) {
    std::int64_t retrace = monitor.retraces() + 1;
    while (retrace % divisor != remainder) {
        ++retrace;
    }
    monitor.now = static_cast<std::int64_t>(static_cast<double>(retrace) * 1e9 / monitor.hertz) + 1;
    monitor.shown[retrace] = monitor.frame;
    return 1;
}

render_node::GlxLoader loaderOfMonitor() {
    using Function = void (*)();
    return {[](const char*) { return true; },
            [](const char* name) -> Function {
                const std::map<std::string, Function> table{
                    {"glXGetSyncValuesOML", reinterpret_cast<Function>(retracesOf)},
                    {"glXSwapBuffersMscOML", reinterpret_cast<Function>(swapAtRetrace)}};
                return table.at(name);
            },
            nullptr, 0};
}

/// Shows frames for a second of the monitor's time. The glasses change eyes at every retrace.
ByEye shownInASecond(double wallHertz, std::int64_t draws /* [ns] */) {
    monitor = {};
    FrameClock clock(wallHertz);
    render_node::EyesByRetrace eyes(loaderOfMonitor(), 11);
    for (; monitor.now < kSessionStart + kOneSecond; ++monitor.frame) {
        monitor.now += clock.begin(monitor.now) + draws;
        EXPECT_TRUE(eyes.swap(monitor.frame));
    }
    ByEye shown{};
    for (const auto& [retrace, frame] : monitor.shown) {
        ++shown.at(frame % 2);
        EXPECT_EQ((retrace - monitor.shown.begin()->first) % 2, static_cast<std::int64_t>(frame % 2))
            << "frame " << frame << " is seen by the other eye";
    }
    return shown;
}

// From the wall file to the retraces of a monitor that runs at the wall file's rate.
TEST(FrameClock, LeadsEachEyeToEverySecondRetraceOfA120HertzMonitor) {
    for (const std::int64_t draws : {1'000'000, 6'000'000}) {
        const ByEye shown = shownInASecond(refreshOf("flex_cave.toml"), draws);
        EXPECT_NEAR(shown[0], 60, 1) << "drawing takes " << draws << " ns";
        EXPECT_NEAR(shown[1], 60, 1) << "drawing takes " << draws << " ns";
    }
    EXPECT_NEAR(shownInASecond(60, 1'000'000)[0], 30, 1) << "a wall with half of the rate";
}

}  // namespace
