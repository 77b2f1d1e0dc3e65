// SPDX-License-Identifier: Apache-2.0
// Hands other than the built-in ones, over whole sessions.
#include <csignal>
#include <filesystem>

#include "sand/esri_grid.hpp"
#include "tests/cluster/session_fixture.hpp"
#include "tests/support/run_program.hpp"

namespace {

using Devices = SessionTest;

TEST_F(Devices, ASenderOfPositionsAloneMovesTheSandOfEveryRank) {
    support::ChildProcess sender(
        {"/usr/bin/env", "python3", (SANDWALL_SOURCE_DIR "/haptic_bridge/examples/position_sender.py"), "--listen",
         "127.0.0.1:0"},
        folder_ / "sender.txt");
    ASSERT_TRUE(sender.waitForOutput("listening on 127.0.0.1:", 30)) << sender.output();
    const std::string said = sender.output();
    const std::string port = said.substr(said.find("127.0.0.1:"));
    const Ended ended = runToEnd({"--wall", wall(1, 2), "--scene", scene(), "--haptic", port.substr(0, port.find('\n')),
                                  "--steps", "120", "--out", out(), "--no-pictures"});
    ASSERT_EQ(ended.status, 0) << ended.output;
    EXPECT_NE(ended.output.find("'circles' streams positions; the master numbers the steps"), std::string::npos)
        << ended.output;
    EXPECT_EQ(ended.output.find("without a hand"), std::string::npos) << ended.output;
    EXPECT_EQ(summary()["steps"], 120);
    EXPECT_EQ(summary()["divergences"], 0);
    const support::Ran replayed = support::runProgram(
        "sandwall-replay", out() + "/session.journal --hash --heights " + (folder_ / "h.asc").string());
    EXPECT_EQ(replayed.status, 0);
    EXPECT_EQ(replayed.output, summary()["state_hash"].get<std::string>() + "\n");
    const sand::EsriGrid grid = sand::readEsriGrid((folder_ / "h.asc").string());
    double lowest = 1;
    for (const double height : grid.heights) {
        lowest = std::min(lowest, height);
    }
    EXPECT_LT(lowest, 0.199) << "a furrow";
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
        // What was felt of steps that the wall did not come to show stands in the record alone.
        ASSERT_LE(same.size(), rows.size());
        EXPECT_TRUE(same == rows.substr(0, same.size())) << pace << ": the rows differ";
        const auto count = std::count(same.begin(), same.end(), '\n');
        EXPECT_GT(count, pace == "fast" ? 90 * 1000 / 60 : 500) << "of a second and a half";
        EXPECT_NE(same.find(",1\n"), std::string::npos) << "the hand never touched the sand";
    }
}

TEST_F(Devices, AJournalWithoutTicksSaysHowToGetThem) {
    const Ended ended = runToEnd(
        {"--wall", wall(1, 1), "--scene", scene(), "--steps", "10", "--pace", "fast", "--out", out(), "--no-pictures"});
    ASSERT_EQ(ended.status, 0) << ended.output;
    const support::Ran replayed =
        support::runProgram("sandwall-replay", out() + "/session.journal --forces " + (folder_ / "again.csv").string());
    EXPECT_EQ(replayed.status, 2);
    EXPECT_NE(replayed.output.find("holds no tick track"), std::string::npos) << replayed.output;
}

}  // namespace
