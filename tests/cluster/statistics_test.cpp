// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>

#include "pictures/png_file.hpp"
#include "tests/cluster/session_fixture.hpp"
#include "tests/support/screens/x_screen.hpp"
#include "tests/support/screens/x_server.hpp"

namespace {

/// The report of a session on its ranks: the slowest one, and the cost of all.
class WallStatistics : public SessionTest {
protected:
    std::vector<std::string> stillWall(int rows, int columns, const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"--wall", wall(rows, columns), "--scene", scene(), "--out", out()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    }
};

// Nothing is drawn, so only the barrier can show which rank is slow. The injected delay is far above the delays of a
// busy machine.
TEST_F(WallStatistics, NameTheRankThatIsSlowOnAStillWallNowAndInTheSummary) {
    const auto session = start(stillWall(2, 2, {"--no-pictures", "--inject", "slow:rank=3,ms=150,frame=2"}));
    expectFrames(*session);
    const nlohmann::json slow = awaitStatus([](const nlohmann::json& now) {
        return now["slowest"].is_object() && now["slowest"]["rank"] == 3 && now["frame"] >= 10;
    });
    EXPECT_NE(slow["slowest"]["name"].get<std::string>().find("r2c1"), std::string::npos) << slow;
    session->type("stop");
    expectInOrder(*session);
    const nlohmann::json result = summary();
    EXPECT_EQ(result["slowest"]["rank"], 3);
    EXPECT_GE(result["per_rank"][2]["draw_ms"]["p50"], 150) << "the injected fault takes 150 ms per frame";
    EXPECT_EQ(result["per_rank"][2]["frames_agreed"], result["frames"]);
    EXPECT_EQ(result["divergences"], 0);
}

TEST_F(WallStatistics, ComeAndGoInThePicturesAtTheOperatorsWish) {
    const auto session = start(stillWall(1, 2, {"--no-pictures", "--show", "statistics"}));
    expectFrames(*session);
    for (const char* words :
         {"capture", "hide statistics", "capture", "show statistics", "capture", "hide statistics", "capture"}) {
        ask(words);
    }
    session->type("stop");
    expectInOrder(*session);
    const auto picture = [this](int number) {
        return pictures::readPng(folder_ / "out" / ("capture_00" + std::to_string(number)) / "tile_r1c2_right.png");
    };
    const pictures::Image shown = picture(1), hidden = picture(2);
    EXPECT_NE(picture(3).rgb, hidden.rgb);
    EXPECT_EQ(picture(4).rgb, hidden.rgb) << "hidden statistics must not change the picture";
    // A picture has 96 x 72 pixels. A panel of four short lines is at the top left, and the sand below it is unchanged.
    const auto row = [](const pictures::Image& image, int y) {
        const auto begin = image.rgb.begin() + std::ptrdiff_t{3} * image.width * y;
        return std::vector(begin, begin + std::ptrdiff_t{3} * image.width);
    };
    EXPECT_NE(row(shown, 6), row(hidden, 6));
    for (int y = 44; y < 72; ++y) {
        EXPECT_EQ(row(shown, y), row(hidden, y)) << "row " << y;
    }
}

// With a number of steps, a session makes them also at rest. At six frames per second each frame then takes as many
// steps as a frame may hold, even on a busy machine. So the frame messages differ only by the statistics.
TEST_F(WallStatistics, TravelOnlyWhileTheyAreShown) {
    const auto usualBytes = [this](std::vector<std::string> more) {
        more.insert(more.end(), {"--steps", "80", "--refresh", "6", "--no-pictures"});
        const Ended ended = runToEnd(stillWall(1, 2, more));
        EXPECT_EQ(ended.status, 0) << ended.output;
        return summary()["broadcast_bytes"]["p50"].get<double>();
    };
    const double unobserved = usualBytes({});
    EXPECT_GT(usualBytes({"--show", "statistics"}), unobserved);
}

/// Times of a thread since its start, as the kernel counts them [s].
struct ThreadTimes {
    double ran = 0;      // time on a core
    double queued = 0;   // ready to run, while others had the cores
    double counted = 0;  // the clock of the measurement, the same for all threads

    /// Returns the share of the time since `then` in which the thread ran, not counting the time in the queue for a
    /// core. It is 1 for a thread that spins, even on a busy machine.
    [[nodiscard]] double busySince(const ThreadTimes& then) const {
        return (ran - then.ran) / (counted - then.counted - (queued - then.queued));
    }
};

/// Returns the times of all threads of `processes`, by thread number.
std::map<std::string, ThreadTimes> threadTimes(const std::vector<pid_t>& processes) {
    std::map<std::string, ThreadTimes> times;
    for (const pid_t pid : processes) {
        std::error_code gone;
        for (const auto& thread : std::filesystem::directory_iterator("/proc/" + std::to_string(pid) + "/task", gone)) {
            double ran = 0, queued = 0;  // [ns]
            if (std::ifstream(thread.path() / "schedstat") >> ran >> queued) {
                const std::chrono::duration<double> now = std::chrono::steady_clock::now().time_since_epoch();
                times[thread.path().filename()] = {ran * 1e-9, queued * 1e-9, now.count()};
            }
        }
    }
    return times;
}

// Ranks that waited by spinning took 84 % of a core on a busy machine, and all cores on an idle one. Processor time
// alone would depend on the load of the machine. A spinning thread runs whenever it does not queue for a core. A
// sleeping thread runs for little of that time. All threads together took 14 to 20 % of a core, on an idle machine and
// on a busy one. They took 45 to 66 % when waits only yielded.
TEST_F(WallStatistics, AStillWallLeavesTheCoresIdle) {
    const auto session = start(stillWall(2, 3, {"--frames", "100000", "--no-pictures"}));
    const auto reached = [&](int frame) {
        const auto event = session->waitForEvent("progress", [&](const auto& one) { return one["frame"] >= frame; });
        EXPECT_FALSE(event.is_null()) << session->output();
        return event.is_null() ? 0 : event["frame"].get<int>();
    };
    const int first = reached(30);
    const std::vector<pid_t> processes = session->family();
    const auto before = threadTimes(processes);
    reached(first + 120);
    const auto after = threadTimes(processes);
    session->type("stop");
    expectInOrder(*session);
    double share = 0;
    for (const auto& [thread, times] : after) {
        if (const auto then = before.find(thread); then != before.end()) {
            share += times.busySince(then->second);
        }
    }
    std::printf("seven processes of a still wall: %.1f %% of one core\n", 100 * share);
    EXPECT_GT(share, 0) << "the measurement found no running thread";
    EXPECT_LT(share, 0.4);
}

/// Ranks whose clocks differ, as those of machines that have been switched on at different times.
class Clocks : public SessionTest {
protected:
    // The tests bound no real time: a session that ignores the clocks is wrong by this much.
    static constexpr double kAhead = 1000;  // [s]

    /// Sets the clock of this rank ahead (tests/support/machine/other_clock.cpp).
    void setAhead(int rank) {
        environment_ = {"LD_PRELOAD=" + support::linkTo("other-clock.so", folder_),
                        "SANDWALL_CLOCK_RANK=" + std::to_string(rank),
                        "SANDWALL_CLOCK_AHEAD=" + std::to_string(static_cast<int>(kAhead))};
    }
};

// Rank 1 is slow, so that the wall waits for it. The clock of rank 2 is ahead.
TEST_F(Clocks, ThatDifferChangeNoTimeOfTheSummary) {
    setAhead(2);
    const Ended ended =
        runToEnd({"--wall", wall(1, 3, "mono"), "--scene", scene(), "--device", "script:gis", "--frames", "40",
                  "--no-pictures", "--inject", "slow:rank=1,ms=150,frame=2", "--out", out()});
    expectInOrder(ended);
    const nlohmann::json result = summary();
    EXPECT_LT(result["skew_us"]["max"], 1e6 * kAhead / 2) << "times of swaps";
    ASSERT_EQ(result["per_rank"].size(), 3U);
    const nlohmann::json& waited = result["per_rank"][0]["slowest"]["wall_waited_ms"];
    EXPECT_GT(waited["max"], 0);
    EXPECT_LT(waited["max"], 1e3 * kAhead / 2) << "times of arrivals";
    EXPECT_EQ(result["slowest"]["rank"], 1);
    EXPECT_LT(std::abs(result["latency_legs_ms"]["drawn"]["p99"].get<double>()), 1e3 * kAhead / 2) << "from arrivals";
}

TEST_F(Clocks, ThatDifferChangeNoTimeOfAPointer) {
    const support::XServer server(folder_, {"640x480x24"});
    setAhead(1);
    environment_.push_back("DISPLAY=" + server.display());
    const std::string oneTile = wall(1, 1, "mono");
    std::ofstream(oneTile, std::ios::app) << "[[place]]\ntiles = [\"r1c1\"]\nwindows = [[10, 20]]\n";
    const auto session =
        start({"--wall", oneTile, "--scene", scene(), "--device", "pointer", "--no-pictures", "--out", out()});
    expectFrames(*session);
    {
        const support::XScreen screen(server.display());
        ASSERT_EQ(screen.windows().size(), 1U);
        const auto window = screen.windows().front();
        screen.point(window, 48, 36);
        screen.button(window, 1, true);
        int x = 48;
        awaitStatus([&](const nlohmann::json& now) {
            screen.point(window, x = x < 60 ? x + 1 : 40, 36);
            return now["can_undo"] == true && now["step"] > 20;
        });
    }
    session->type("stop");
    expectInOrder(*session);
    const double latency = summary()["latency_ms"]["p50"];
    EXPECT_GT(latency, 0) << "from the motion of the pointer to the picture";
    EXPECT_LT(latency, 1e3 * kAhead / 2);
}

}  // namespace
