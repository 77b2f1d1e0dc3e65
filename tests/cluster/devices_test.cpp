// SPDX-License-Identifier: Apache-2.0
// Sessions with hands other than the built-in ones, and the force at an arm whose processes hang and start again.
#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <regex>
#include <sstream>

#include "scene/import/esri_file.hpp"
#include "tests/cluster/session_fixture.hpp"
#include "tests/support/processes/run_program.hpp"

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

/// A session whose arm presses into the sand and logs the forces that it takes
/// (tests/haptic_bridge/devices/logging_driver.cpp). A server that starts again begins a new log.
class Force : public SessionTest {
protected:
    [[nodiscard]] std::string device() const {
        return "driver:" SANDWALL_BIN_DIR "/logging-driver.so:none:" + (folder_ / "forces").string();
    }
    /// Returns the magnitude of each force that the arm of the present server took [N].
    [[nodiscard]] std::vector<double> forces() const {
        std::vector<double> all;
        std::istringstream rows(read("forces"));
        for (std::string row; std::getline(rows, row) && !rows.eof();) {  // the last row may not be whole
            std::istringstream parts(row);
            double time = 0, x = 0, y = 0, z = 0;
            if (parts >> time >> x >> y >> z) {
                all.push_back(std::sqrt(x * x + y * y + z * z));
            }
        }
        return all;
    }
    /// Returns whether the last `count` forces are 0, or all of them above 0.
    [[nodiscard]] bool lastAre(bool zero, std::size_t count = 200) const {
        const std::vector<double> all = forces();
        return all.size() >= count && std::all_of(all.end() - static_cast<std::ptrdiff_t>(count), all.end(),
                                                  [zero](double force) { return (force == 0) == zero; });
    }
    static void strike(const support::ChildProcess& session, const std::string& program, int signal) {
        kill(support::findProgram(session.family(), program).value(), signal);
    }
    [[nodiscard]] static std::size_t links(const support::ChildProcess& session) {
        const std::vector<nlohmann::json> all = session.events("link");
        return static_cast<std::size_t>(std::count_if(
            all.begin(), all.end(), [](const nlohmann::json& event) { return event["state"] == "linked"; }));
    }
};

TEST_F(Force, SwitchedOffByAnOperatorStaysOffWhenEveryProcessHasStartedAgain) {
    const auto session = start({"--wall", wall(1, 1, "mono"), "--scene", scene(), "--device", device(), "--out", out(),
                                "--no-pictures", "--restarts", "100", "--restart-window", "0.001"});
    expectHand(*session);
    ASSERT_TRUE(session->waitUntil([&] { return lastAre(false); })) << session->output();
    EXPECT_TRUE(ask("status")["force_share"].is_null());
    EXPECT_EQ(ask("status")["force_ceiling"], 1);
    (void)ask("force off");
    ASSERT_TRUE(session->waitUntil([&] { return lastAre(true); })) << session->output();

    const std::size_t before = links(*session);
    strike(*session, "sandwall-master", SIGKILL);
    ASSERT_TRUE(session->waitUntil([&] { return links(*session) > before; })) << session->output();
    EXPECT_EQ(ask("status")["force_share"], 0);
    strike(*session, "sandwall-haptic-server", SIGKILL);
    ASSERT_TRUE(session->waitUntil([&] { return links(*session) > before + 1; })) << session->output();
    const int linked = ask("status")["step"];
    awaitStatus([&](const nlohmann::json& now) { return now.value("step", 0) > linked + 120; });
    const std::vector<double> all = forces();
    EXPECT_GT(all.size(), 1000U) << "two seconds of the new server";
    EXPECT_EQ(std::count_if(all.begin(), all.end(), [](double force) { return force > 0; }), 0);

    (void)ask("force on");
    EXPECT_TRUE(session->waitUntil([&] { return lastAre(false); })) << session->output();
    session->signal(SIGINT);
    expectInOrder(*session);
    EXPECT_EQ(forces().back(), 0);
    EXPECT_GT(summary()["haptic"]["asked_ticks"]["off"], 1000);
}

TEST_F(Force, FadesWhileTheMasterHangs) {
    const auto session = start({"--wall", wall(1, 1, "mono"), "--scene", scene(), "--device", device(), "--out", out(),
                                "--no-pictures", "--force-scale", "0.75"});
    expectHand(*session);
    ASSERT_TRUE(session->waitUntil([&] { return lastAre(false); })) << session->output();
    strike(*session, "sandwall-master", SIGSTOP);
    // On a busy machine slow motion may have begun the fall. A second is long enough for the stop itself to count.
    EXPECT_TRUE(session->waitUntil([&] { return lastAre(true, 1000); })) << session->output();
    strike(*session, "sandwall-master", SIGCONT);
    EXPECT_TRUE(session->waitUntil([&] { return lastAre(false); })) << session->output();
    session->signal(SIGINT);
    expectInOrder(*session);
    EXPECT_GT(summary()["haptic"]["guarded_ticks"]["frozen"], 0);
    EXPECT_GT(summary()["haptic"]["asked_ticks"]["steps"], 0);
    EXPECT_EQ(forces().back(), 0);
}

}  // namespace
