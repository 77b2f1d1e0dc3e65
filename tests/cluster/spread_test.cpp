// SPDX-License-Identifier: Apache-2.0
// Steps of many sweeps that are spread over frames, and steps with a coarse phase: processes that are killed meanwhile,
// and walls that are slow.
#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <map>
#include <string>
#include <vector>

#include "master/journal/journal.hpp"
#include "sand/replica.hpp"
#include "tests/cluster/session_fixture.hpp"

namespace {

/// A step of the journal.
struct Played {
    std::uint64_t frame = 0, number = 0;
    std::uint32_t epoch = 0;
    bool owes = false;  // whether sweeps are owed after it
    std::int64_t phases = 0;
};

/// The tool has a radius of 16 cells and a short settling time. A step has 2134 sweeps, and so takes many frames. A
/// larger tool would have a coarse phase and few sweeps.
class Spread : public SessionTest {
protected:
    std::string slowTool() {
        return write("scene.toml",
                     "name = \"test\"\n[field]\ncolumns = 128\nrows = 128\n[terrain]\nheight = 0.9\n"
                     "[material]\nsettling_time = 0.002\n[tool]\nradius = 0.25\n");
    }
    std::unique_ptr<support::ChildProcess> begin() {
        auto session = start({"--wall", wall(1, 2, "mono"), "--scene", slowTool(), "--device", "script:gis", "--out",
                              out(), "--no-pictures", "--restarts", "100000", "--restart-window", "0.001"});
        EXPECT_FALSE(session->waitForEvent("link", {{"state", "linked"}}).is_null()) << session->output();
        return session;
    }
    /// Pauses the session while sweeps are owed, which are not paid meanwhile. Returns the step that owes them.
    std::uint64_t pauseInAStep() const {
        for (int tries = 0; tries < 100 && !HasFailure(); ++tries) {
            awaitStatus([](const nlohmann::json& now) { return now.value("sweeps_owed", 0) > 0; });
            ask("pause");
            // The frame that was shown meanwhile may have paid the last of them.
            const nlohmann::json now = ask("status");
            if (now.value("sweeps_owed", 0) > 0) {
                return now["step"];
            }
            ask("resume");
        }
        ADD_FAILURE() << "no step was spread over frames";
        return 0;
    }
    static void kill(const support::ChildProcess& session, const std::string& program) {
        ::kill(support::findProgram(session.family(), program).value(), SIGKILL);
    }
    /// Plays the journal as an undisturbed replica does.
    [[nodiscard]] std::vector<Played> played() const {
        const journal::Journal whole = master::readJournal(folder_ / "out" / "session.journal");
        sand::Replica replica(whole.scene);
        std::vector<Played> steps;
        for (const journal::JournalFrame& frame : whole.frames) {
            for (const sand::Step& step : frame.steps) {
                replica.apply(step);
                steps.push_back(
                    {frame.frame, step.number, step.epoch, replica.owed().any(), replica.lastWork().phases});
            }
        }
        return steps;
    }
    /// Returns whether sweeps are owed after step `number` of the journal.
    [[nodiscard]] bool owesAfter(std::uint64_t number) const {
        const std::vector<Played> steps = played();
        return std::any_of(steps.begin(), steps.end(),
                           [&](const Played& step) { return step.number == number && step.owes; });
    }
    /// Returns how many steps of the journal leave sweeps to later steps.
    [[nodiscard]] std::ptrdiff_t stepsThatOwe() const {
        const std::vector<Played> steps = played();
        return std::count_if(steps.begin(), steps.end(), [](const Played& step) { return step.owes; });
    }
    void expectOneSand(support::ChildProcess& session) const {
        session.signal(SIGINT);
        expectInOrder(session);
        EXPECT_EQ(summary()["divergences"], 0);
        EXPECT_EQ(summary()["server_divergences"], 0);
        EXPECT_EQ(summary()["steps_left_out"], 0);
        EXPECT_EQ(summary()["state_hash"], replayedHash());
    }
};

// The new processes continue in the middle of the step, from the journal.
TEST_F(Spread, ARankAndTheMasterThatAreKilledInAStepLoseNothing) {
    const auto session = begin();
    std::vector<std::uint64_t> killed;
    for (const char* program : {"sandwall-render-node", "sandwall-master"}) {
        SCOPED_TRACE(program);
        killed.push_back(pauseInAStep());
        const std::size_t recovered = session->events("recovered").size();
        kill(*session, program);
        ASSERT_TRUE(session->waitUntil([&] { return session->events("recovered").size() > recovered; }))
            << session->output();
        EXPECT_EQ(session->events("recovered").back()["recovery"]["step"], killed.back());
        awaitStatus([&](const nlohmann::json& now) { return now.value("step", std::uint64_t{0}) > killed.back() + 3; });
    }
    expectOneSand(*session);
    for (const std::uint64_t step : killed) {
        EXPECT_TRUE(owesAfter(step)) << step;
    }
}

// The master pays the rest of the step. The session is paused until it has missed the server, because a long frame
// could last until the next server is there.
TEST_F(Spread, TheMasterTakesOverFromAServerThatIsKilledInAStep) {
    const auto session = begin();
    const std::uint64_t killed = pauseInAStep();
    kill(*session, "sandwall-haptic-server");
    ASSERT_FALSE(session->waitForEvent("without_hand", {{"reason", "lost"}}).is_null()) << session->output();
    ask("resume");
    awaitStatus([&](const nlohmann::json& now) { return now.value("step", std::uint64_t{0}) > killed + 30; });
    expectOneSand(*session);
    EXPECT_TRUE(owesAfter(killed));
}

// The healed rank continues in the middle of the step, too. How many steps a frame has depends on the load, so that a
// step may just have ended in the frame of the drill. Then another frame is tried.
TEST_F(Spread, ARankIsHealedInAStep) {
    bool inAStep = false;
    for (int frame = 60; frame < 64 && !inAStep; ++frame) {
        const Ended ended = runToEnd({"--wall", wall(1, 2, "mono"), "--scene", slowTool(), "--device", "script:gis",
                                      "--out", out(), "--no-pictures", "--pace", "fast", "--steps", "400", "--inject",
                                      "diverge:rank=1,frame=" + std::to_string(frame) + ",bit=12"});
        EXPECT_EQ(ended.status, 0) << ended.output;
        EXPECT_EQ(summary()["divergences"], 1);
        EXPECT_EQ(summary()["healed"], 1);
        EXPECT_EQ(summary()["server_divergences"], 0);
        EXPECT_EQ(summary()["state_hash"], replayedHash());
        const journal::Journal whole = master::readJournal(folder_ / "out" / "session.journal");
        const std::uint64_t healed = summary()["compared"]["first_difference"];
        for (const journal::JournalFrame& shown : whole.frames) {
            inAStep = inAStep || (shown.frame == healed && owesAfter(shown.steps.back().number));
        }
    }
    EXPECT_TRUE(inAStep);
}

// A rank that is slow draws for longer, and so changes all times by which steps of a real hand are divided.
TEST_F(Spread, WithTheFastPaceTheSandDependsOnNoLoad) {
    constexpr int kSteps = 200;
    std::vector<nlohmann::json> ends;
    for (const std::string fault : {"", "slow:rank=1,ms=15"}) {
        SCOPED_TRACE(fault);
        std::vector<std::string> arguments{
            "--wall", wall(1, 2, "mono"), "--scene", slowTool(), "--device", "script:gis",          "--out",
            out(),    "--no-pictures",    "--pace",  "fast",     "--steps",  std::to_string(kSteps)};
        if (!fault.empty()) {
            arguments.insert(arguments.end(), {"--inject", fault});
        }
        const Ended ended = runToEnd(arguments);
        ASSERT_EQ(ended.status, 0) << ended.output;
        ends.push_back(summary());
        EXPECT_EQ(ends.back()["steps"], kSteps);
        EXPECT_EQ(ends.back()["state_hash"], ends.front()["state_hash"]);
    }
    EXPECT_GT(stepsThatOwe(), kSteps / 2) << "few steps were spread, so that the test shows nothing";
}

/// The tool has a radius of 30 cells on a field of 128 x 128 cells.
class LargeToolSession : public Spread {
protected:
    std::vector<std::string> arguments() {
        const std::string scene = write("scene.toml",
                                        "name = \"test\"\n[field]\ncolumns = 128\nrows = 128\n[terrain]\nheight = "
                                        "0.9\n[material]\n[tool]\nradius = 0.46875\n");
        return {"--wall", wall(1, 2, "mono"), "--scene",    scene,    "--device",         "script:gis", "--out",
                out(),    "--no-pictures",    "--restarts", "100000", "--restart-window", "0.001"};
    }
};

// The hand of a fast session digs from step 1 to step 73, about four steps in a frame. The rank that dies is started
// again. The flipped bit is found and healed.
TEST_F(LargeToolSession, LosesNothingIfRanksDieAndDifferInACoarsePhase) {
    constexpr std::uint64_t kDies = 6, kDiffers = 12;  // frames
    std::vector<std::string> all = arguments();
    all.insert(all.end(), {"--pace", "fast", "--steps", "150", "--inject", fmt::format("die:rank=1,frame={}", kDies),
                           "--inject", fmt::format("diverge:rank=2,frame={},bit=12", kDiffers)});
    const Ended ended = runToEnd(all);
    EXPECT_EQ(ended.status, 0) << ended.output;
    EXPECT_GE(summary()["recoveries"].size(), 1U);
    EXPECT_EQ(summary()["healed"], 1);
    EXPECT_EQ(summary()["server_divergences"], 0);
    EXPECT_EQ(summary()["state_hash"], replayedHash());
    std::map<std::uint64_t, std::int64_t> phases;
    for (const Played& step : played()) {
        phases[step.frame] += step.phases;
    }
    EXPECT_GT(phases[kDies], 0);
    EXPECT_GT(phases[kDiffers], 0);
}

TEST_F(LargeToolSession, GoesOnAfterItsHapticServerIsKilledWhileTheToolDigs) {
    const auto session = start(arguments());
    expectHand(*session);
    awaitStatus([&](const nlohmann::json& now) { return now.value("step", 0) > 10; });
    kill(*session, "sandwall-haptic-server");
    // Between the links, the master may have made steps in an epoch of its own.
    const auto again = [](const nlohmann::json& event) { return event["state"] == "linked" && event["epoch"] > 1; };
    ASSERT_FALSE(session->waitForEvent("link", again).is_null()) << session->output();
    const int linked = ask("status")["step"];
    awaitStatus([&](const nlohmann::json& now) { return now.value("step", 0) > linked + 150; });
    expectOneSand(*session);
    const std::vector<Played> steps = played();
    const auto lost = std::find_if(steps.begin(), steps.end(), [](const Played& step) { return step.epoch > 1; });
    const auto digs = [](const Played& step) { return step.phases > 0; };
    EXPECT_TRUE(std::any_of(lost - std::min<std::ptrdiff_t>(lost - steps.begin(), 30), lost, digs)) << "it dug before";
    EXPECT_TRUE(std::any_of(lost, steps.end(), digs)) << "it digs again";
}

}  // namespace
