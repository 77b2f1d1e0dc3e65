// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <sstream>

#include "pictures/png_file.hpp"
#include "tests/cluster/session_fixture.hpp"

namespace {

/// What a session reports of its ranks: which one is the slowest, and what all of them cost.
class WallStatistics : public SessionTest {
protected:
    std::vector<std::string> stillWall(int rows, int columns, const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"--wall", wall(rows, columns), "--scene", scene(), "--out", out()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    }
};

// Nothing is drawn, so that only the barrier can tell which rank is slow. Far above what a busy machine does by chance.
TEST_F(WallStatistics, NameTheRankThatIsSlowOnAStillWallNowAndInTheSummary) {
    const auto session = start(stillWall(2, 2, {"--no-pictures", "--inject", "slow:rank=3,ms=150,frame=2"}));
    expectFrames(*session);
    const nlohmann::json slow = awaitStatus([](const nlohmann::json& now) {
        return now["slowest"].is_object() && now["slowest"]["rank"] == 3 && now["frame"] >= 10;
    });
    EXPECT_NE(slow["slowest"]["name"].get<std::string>().find("r2c1"), std::string::npos) << slow;
    session->type("stop");
    EXPECT_EQ(session->wait(kLong), 0) << session->output();
    const nlohmann::json result = summary();
    EXPECT_EQ(result["slowest"]["rank"], 3);
    EXPECT_GE(result["per_rank"][2]["draw_ms"]["p50"], 150) << "what the fault takes";
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
    EXPECT_EQ(session->wait(kLong), 0) << session->output();
    const auto picture = [this](int number) {
        return pictures::readPng(folder_ / "out" / ("capture_00" + std::to_string(number)) / "tile_r1c2_right.png");
    };
    const pictures::Image shown = picture(1), hidden = picture(2);
    EXPECT_NE(picture(3).rgb, hidden.rgb);
    EXPECT_EQ(picture(4).rgb, hidden.rgb) << "hidden, they leave the sand as it was";
    // 96 x 72 pixels: a panel of four short lines at the top left, and the sand below as it was.
    const auto row = [](const pictures::Image& image, int y) {
        const auto begin = image.rgb.begin() + std::ptrdiff_t{3} * image.width * y;
        return std::vector(begin, begin + std::ptrdiff_t{3} * image.width);
    };
    EXPECT_NE(row(shown, 6), row(hidden, 6));
    for (int y = 44; y < 72; ++y) {
        EXPECT_EQ(row(shown, y), row(hidden, y)) << "row " << y;
    }
}

// At six frames a second each frame takes as many steps as one may, on a busy machine as on an idle one: its message
// differs by the figures alone.
TEST_F(WallStatistics, TravelOnlyWhileTheyAreShown) {
    const auto usualBytes = [this](std::vector<std::string> more) {
        more.insert(more.end(), {"--frames", "9", "--refresh", "6", "--no-pictures"});
        const Ended ended = runToEnd(stillWall(1, 2, more));
        EXPECT_EQ(ended.status, 0) << ended.output;
        return summary()["broadcast_bytes"]["p50"].get<double>();
    };
    const double unobserved = usualBytes({});
    EXPECT_GT(usualBytes({"--show", "statistics"}), unobserved);
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
    const auto reached = [&](int frame) {
        const auto event = session->waitForEvent("progress", [&](const auto& one) { return one["frame"] >= frame; });
        EXPECT_FALSE(event.is_null()) << session->output();
        return event.is_null() ? 0 : event["frame"].get<int>();
    };
    const int first = reached(30);
    const std::vector<pid_t> processes = session->family();
    const double before = processorSeconds(processes);
    const auto since = std::chrono::steady_clock::now();
    reached(first + 120);
    const double took = processorSeconds(processes) - before;
    const double share = took / std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
    session->type("stop");
    EXPECT_EQ(session->wait(kLong), 0) << session->output();
    std::printf("seven processes of a still wall: %.1f %% of one core\n", 100 * share);
    EXPECT_GT(share, 0) << "measured nothing";
    EXPECT_LT(share, 0.5);
}

}  // namespace
