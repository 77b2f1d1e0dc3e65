// SPDX-License-Identifier: Apache-2.0
// Sessions with hands other than the built-in ones.
#include <filesystem>
#include <regex>

#include "scene/import/esri_grid.hpp"
#include "tests/cluster/session_fixture.hpp"
#include "tests/support/run_program.hpp"

namespace {

using Devices = SessionTest;

TEST_F(Devices, ASenderOfPositionsAloneMovesTheSandOfEveryRank) {
    support::ChildProcess sender(
        {"/usr/bin/env", "python3", (SANDWALL_SOURCE_DIR "/haptic_bridge/examples/position_sender.py"), "--listen",
         "127.0.0.1:0"},
        folder_ / "sender.txt");
    // The example prints its address on a line of its own.
    std::smatch address;
    std::string said;
    ASSERT_TRUE(sender.waitUntil([&] {
        said = sender.output();
        return std::regex_search(said, address, std::regex("(127\\.0\\.0\\.1:[0-9]+)\n"));
    })) << said;
    const Ended ended = runToEnd({"--wall", wall(1, 2), "--scene", scene(), "--haptic", address[1], "--steps", "120",
                                  "--out", out(), "--no-pictures"});
    ASSERT_EQ(ended.status, 0) << ended.output;
    EXPECT_TRUE(ended.has("link", {{"state", "streaming"}})) << ended.output;
    EXPECT_TRUE(support::eventsIn(ended.output, "without_hand").empty()) << ended.output;
    EXPECT_EQ(summary()["steps"], 120);
    EXPECT_EQ(summary()["divergences"], 0);
    const support::Ran replayed = support::runProgram(
        "sandwall-replay", out() + "/session.journal --hash --heights " + (folder_ / "h.asc").string());
    EXPECT_EQ(replayed.status, 0);
    EXPECT_EQ(replayed.output, summary()["state_hash"].get<std::string>() + "\n");
    const scene::EsriGrid grid = scene::readEsriGrid((folder_ / "h.asc").string());
    double lowest = 1;
    for (const double height : grid.heights) {
        lowest = std::min(lowest, height);
    }
    EXPECT_LT(lowest, 0.199) << "the hand left no furrow";
}

TEST_F(Devices, ForcesAreRecomputedFromTheJournal) {
    for (const std::string pace : {"fast", "realtime"}) {
        const std::string recorded = (folder_ / "ticks.csv").string(), again = (folder_ / "again.csv").string();
        const Ended ended = runToEnd({"--wall", wall(1, 1), "--scene", scene(), "--device", "script:gis", "--pace",
                                      pace, "--steps", "90", "--out", out(), "--no-pictures", "--record", recorded});
        ASSERT_EQ(ended.status, 0) << ended.output;
        const support::Ran replayed =
            support::runProgram("sandwall-replay", out() + "/session.journal --forces " + again);
        EXPECT_EQ(replayed.status, 0) << replayed.output;
        const std::string rows = read("ticks.csv"), same = read("again.csv");
        // The recording may also have later ticks, of steps that the wall never showed. The journal lacks these ticks.
        ASSERT_LE(same.size(), rows.size());
        EXPECT_TRUE(same == rows.substr(0, same.size())) << pace << ": the rows differ";
        const auto count = std::count(same.begin(), same.end(), '\n');
        EXPECT_GT(count, pace == "fast" ? 90 * 1000 / 60 : 500) << "too few ticks for 1.5 s";
        EXPECT_NE(same.find(",1\n"), std::string::npos) << "the hand never touched the sand";
    }
}

TEST_F(Devices, AJournalWithoutTicksSaysHowToGetThem) {
    const Ended ended = runToEnd(
        {"--wall", wall(1, 1), "--scene", scene(), "--steps", "10", "--pace", "fast", "--out", out(), "--no-pictures"});
    ASSERT_EQ(ended.status, 0) << ended.output;
    const support::Ran replayed =
        support::runProgram("sandwall-replay", out() + "/session.journal --forces " + (folder_ / "again.csv").string());
    expectOneLine({replayed.status, replayed.output}, "session.journal");
}

}  // namespace
