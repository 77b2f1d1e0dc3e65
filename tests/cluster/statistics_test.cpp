// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <sstream>
#include <thread>

#include "pictures/png_file.hpp"
#include "tests/cluster/session_fixture.hpp"
#include "tests/support/run_program.hpp"

namespace {

/// What a session says of its ranks: which one drags it, and what all of them cost.
class WallStatistics : public SessionTest {
protected:
    std::vector<std::string> stillWall(int rows, int columns, const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"--wall", wall(rows, columns), "--scene", scene(), "--out", out()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    }
};

// Nothing is drawn, so that only the barrier can tell who is slow. Far above what a busy machine does by chance.
TEST_F(WallStatistics, NameTheRankThatIsSlowOnAStillWall) {
    const Ended ended = runToEnd(stillWall(
        2, 2, {"--frames", "60", "--no-pictures", "--show", "statistics", "--inject", "slow:rank=3,ms=60,frame=2"}));
    ASSERT_EQ(ended.status, 0) << ended.output;
    EXPECT_NE(ended.output.find("\n  slowest   rank 3 (tile r2c1) on " + host() + " in "), std::string::npos)
        << ended.output;
    const nlohmann::json result = summary();
    EXPECT_EQ(result["slowest"]["rank"], 3);
    EXPECT_GT(result["slowest"]["share"], 0.25);
    EXPECT_GT(result["per_rank"][2]["slowest"]["frames"], result["per_rank"][0]["slowest"]["frames"]);
    EXPECT_GE(result["per_rank"][2]["draw_ms"]["p50"], 60);
    EXPECT_EQ(result["per_rank"][2]["frames_agreed"], 60);
    EXPECT_EQ(result["divergences"], 0);
}

TEST_F(WallStatistics, TellAnOperatorWhoIsSlowNow) {
    const auto session =
        start(stillWall(1, 2, {"--frames", "100000", "--no-pictures", "--inject", "slow:rank=2,ms=60,frame=2"}));
    ASSERT_TRUE(session->waitForOutput("no hand", 60)) << session->output();
    nlohmann::json slowest;
    for (int tries = 0; tries < 100 && !slowest.is_object(); ++tries) {
        const support::Ran ran = support::runCommand(SANDWALL_SOURCE_DIR "/scripts/sandwall ctl " + out() + " status");
        ASSERT_EQ(ran.status, 0) << ran.output;
        slowest = nlohmann::json::parse(ran.output)["slowest"];
    }
    ASSERT_TRUE(slowest.is_object()) << "nobody stands out";
    EXPECT_EQ(slowest["rank"], 2);
    EXPECT_NE(slowest["name"].get<std::string>().find("tile r1c2"), std::string::npos) << slowest;
    EXPECT_EQ(support::runCommand(SANDWALL_SOURCE_DIR "/scripts/sandwall ctl " + out() + " stop").status, 0);
    EXPECT_EQ(session->wait(60), 0) << session->output();
}

TEST_F(WallStatistics, AreShownInThePicturesWhenTheyAreAskedFor) {
    std::vector<pictures::Image> walls;
    for (const bool shown : {false, true}) {
        std::vector<std::string> more{"--frames", "40"};
        if (shown) {
            more.insert(more.end(), {"--show", "statistics"});
        }
        const Ended ended = runToEnd(stillWall(1, 2, more));
        ASSERT_EQ(ended.status, 0) << ended.output;
        walls.push_back(pictures::readPng(folder_ / "out/tile_r1c2_left.png"));
    }
    ASSERT_EQ(walls[0].width, walls[1].width);
    // 96 x 72 pixels: a panel of four short lines at the top left, and the sand below as it was.
    const auto row = [](const pictures::Image& image, int y) {
        const auto begin = image.rgb.begin() + std::ptrdiff_t{3} * image.width * y;
        return std::vector(begin, begin + std::ptrdiff_t{3} * image.width);
    };
    EXPECT_NE(row(walls[0], 6), row(walls[1], 6));
    for (int y = 44; y < 72; ++y) {
        EXPECT_EQ(row(walls[0], y), row(walls[1], y)) << "row " << y;
    }
}

TEST_F(WallStatistics, ComeAndGoAtTheOperatorsWish) {
    const auto session = start(stillWall(1, 2, {"--frames", "100000", "--no-pictures"}));
    ASSERT_TRUE(session->waitForOutput("no hand", 60)) << session->output();
    for (const char* words : {"capture", "show statistics", "capture", "hide statistics", "capture", "stop"}) {
        const support::Ran ran =
            support::runCommand(SANDWALL_SOURCE_DIR "/scripts/sandwall ctl " + out() + " " + words);
        EXPECT_EQ(ran.status, 0) << words << ": " << ran.output;
    }
    EXPECT_EQ(session->wait(60), 0) << session->output();
    const auto picture = [this](int number) {
        return read("out/capture_00" + std::to_string(number) + "/tile_r1c2_right.png");
    };
    ASSERT_FALSE(picture(1).empty());
    EXPECT_NE(picture(2), picture(1));
    EXPECT_EQ(picture(3), picture(1)) << "hidden, they leave the sand as it was";
}

// At five frames a second each frame takes as many steps as one may, on a busy machine as on an idle one: its message
// differs by the figures alone.
TEST_F(WallStatistics, TravelOnlyWhileTheyAreShown) {
    const auto usualBytes = [this](std::vector<std::string> more) {
        more.insert(more.end(), {"--frames", "11", "--refresh", "5", "--no-pictures"});
        const Ended ended = runToEnd(stillWall(1, 2, more));
        EXPECT_EQ(ended.status, 0) << ended.output;
        return summary()["broadcast_bytes"]["p50"].get<double>();
    };
    const double unobserved = usualBytes({});
    EXPECT_GT(usualBytes({"--show", "statistics"}), unobserved);
}

TEST_F(WallStatistics, AFaultThatCannotBeIsNamed) {
    for (const auto& [fault, part] : {std::pair{"slow:rank=9,ms=30", "rank must be 1 to 2, got '9'"},
                                      {"nap:rank=1", "no such fault; write slow:rank=R,ms=MS"}}) {
        const Ended ended = runToEnd(stillWall(1, 2, {"--inject", fault}), 60);
        EXPECT_EQ(ended.status, 2) << ended.output;
        EXPECT_EQ(std::count(ended.output.begin(), ended.output.end(), '\n'), 1) << ended.output;
        EXPECT_NE(ended.output.find(part), std::string::npos) << ended.output;
    }
}

/// Processor time of the processes so far [s].
double processorSeconds(const std::vector<pid_t>& processes) {
    double ticks = 0;
    for (const pid_t pid : processes) {
        std::ifstream stream("/proc/" + std::to_string(pid) + "/stat");
        std::string text{std::istreambuf_iterator<char>(stream), {}};
        std::istringstream fields(text.substr(std::min(text.size(), text.rfind(')') + 1)));
        std::string ignored;
        for (int i = 0; i < 11; ++i) {
            fields >> ignored;
        }
        double user = 0, system = 0;
        fields >> user >> system;
        ticks += user + system;
    }
    return ticks / static_cast<double>(sysconf(_SC_CLK_TCK));
}

// Ranks that waited by spinning took whatever was idle: 84 % of a core on a machine whose cores others kept busy, and
// all cores of one of its own. Now it is about a tenth of one core.
TEST_F(WallStatistics, AStillWallLeavesTheCoresIdle) {
    const auto session = start(stillWall(2, 3, {"--frames", "100000", "--no-pictures"}));
    ASSERT_TRUE(session->waitForOutput("no hand", 60)) << session->output();
    std::this_thread::sleep_for(std::chrono::seconds(1));
    const std::vector<pid_t> processes = session->family();
    const double before = processorSeconds(processes);
    const auto since = std::chrono::steady_clock::now();
    std::this_thread::sleep_for(std::chrono::seconds(3));
    const double took = processorSeconds(processes) - before;
    const double share = took / std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
    session->type("stop");
    EXPECT_EQ(session->wait(60), 0) << session->output();
    std::printf("seven processes of a still wall: %.1f %% of one core\n", 100 * share);
    EXPECT_GT(share, 0) << "measured nothing";
    EXPECT_LT(share, 0.5);
}

}  // namespace
