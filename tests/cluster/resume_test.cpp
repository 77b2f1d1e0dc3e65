// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <variant>
#include <vector>

#include "haptic_bridge/link/protocol.hpp"
#include "journal/reader.hpp"
#include "master/journal/checkpoint.hpp"
#include "master/journal/journal.hpp"
#include "tests/cluster/session_fixture.hpp"
#include "tests/support/processes/run_program.hpp"

namespace {

/// A session that is stopped and resumed.
class Resuming : public SessionTest {
protected:
    std::unique_ptr<support::ChildProcess> begin(const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"--wall",        wall(1, 2),     "--scene", scene(),      "--out", out(),
                                           "--no-pictures", "--checkpoint", "0.2",     "--restarts", "0"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        auto session = start(arguments);
        expectFrames(*session);
        return session;
    }
    [[nodiscard]] std::filesystem::path journal() const { return folder_ / "out" / "session.journal"; }
    void awaitCheckpoint(support::ChildProcess& session, std::uint64_t after) const {
        EXPECT_TRUE(session.waitUntil([&] {
            const auto steps = master::checkpointsOf(journal());
            return !steps.empty() && steps.front() > after;
        })) << "no checkpoint was written in time";
    }
    /// Returns the numbers of all edits in the journal.
    [[nodiscard]] std::vector<std::uint64_t> edits() const {
        std::vector<std::uint64_t> numbers;
        for (const journal::JournalFrame& frame : master::readJournal(journal()).frames) {
            for (const sand::Step& step : frame.steps) {
                if (step.edit.any()) {
                    numbers.push_back(step.edit.number);
                }
            }
        }
        return numbers;
    }
    static pid_t masterOf(const support::ChildProcess& session) {
        return support::findProgram(session.family(), "sandwall-master").value();
    }
    [[nodiscard]] nlohmann::json recoveries() const {
        nlohmann::json all = nlohmann::json::array();
        std::ifstream stream(folder_ / "out" / "recoveries.jsonl");
        for (std::string line; std::getline(stream, line);) {
            all.push_back(nlohmann::json::parse(line));
        }
        return all;
    }
};

// The session is killed and its journal torn. It is resumed, and then the disk refuses to write. It is resumed again
// and runs to its end. All three runs are one session with one journal and one sand.
TEST_F(Resuming, ASessionGoesOnWhereItStopped) {
    auto session = begin({});
    ask("tool ellipse radius=0.05 width=0.5");
    const std::uint64_t tuned = ask("status")["step"];
    awaitCheckpoint(*session, tuned);
    ask("pause");
    EXPECT_EQ(ask("settle")["waits_for"], "resume") << "this edit is in no step when the session is killed";
    kill(masterOf(*session), SIGKILL);
    EXPECT_NE(session->wait(kLong).value_or(0), 0) << session->output();
    std::ofstream(journal(), std::ios::app | std::ios::binary) << "torn off";

    session = begin({"--resume"});
    EXPECT_FALSE(session->waitForEvent("resumed", {{"cut_bytes", 8}}).is_null()) << session->output();
    EXPECT_FALSE(session->waitForEvent("recovered", {{"recovery", {{"cut_bytes", 8}}}}).is_null()) << session->output();
    const nlohmann::json status = ask("status");
    EXPECT_GT(status["step"], tuned);
    EXPECT_EQ(status["tool_shape"], "ellipse");
    EXPECT_EQ(status["edits"], 1);
    EXPECT_EQ(status["journal_policy"], "required");
    EXPECT_EQ(status["journal_state"], "written");
    // The tool is as the operator set it, and not as the scene defines it.
    ask("tool width=0.4");
    EXPECT_NEAR(ask("status")["tool_radius"].get<double>(), 0.05, 1e-3);
    rlimit none{1, 1};
    ASSERT_EQ(prlimit(masterOf(*session), RLIMIT_FSIZE, &none, nullptr), 0);
    (void)answer("settle");  // sand that rests writes nothing; the session ends before it answers
    EXPECT_EQ(session->wait(kLong), 1) << session->output();
    EXPECT_FALSE(session->waitForEvent("failure", {{"failure", {{"what", "disk"}}}}).is_null()) << session->output();

    const auto before = recoveries();
    ASSERT_EQ(before.size(), 1U);
    EXPECT_EQ(before[0]["cut_bytes"], 8);
    EXPECT_GT(before[0]["checkpoint_step"], 0);
    const std::uint64_t end = before[0]["step"].get<std::uint64_t>() + 400;
    nlohmann::json incidents{{"divergences", 3},    {"healed", 2},           {"outvoted", 1}, {"server_divergences", 0},
                             {"links", 5},          {"reconnects", 4},       {"stands", 1},   {"steps_left_out", 8},
                             {"steps_unplaced", 9}, {"first_difference", 17}};
    for (const auto& [code, kind] : valuesOf(haptic_bridge::RefusalCode{})) {
        incidents["refused_by_server"][std::string(kind)] = 6;
        incidents["refused"][std::string(kind)] = 7;
    }
    write("out/incidents.json", incidents.dump());
    const Ended ended = runToEnd({"--wall", wall(1, 2), "--out", out(), "--no-pictures", "--resume", "--steps",
                                  std::to_string(end), "--pace", "fast", "--restarts", "0"});
    ASSERT_EQ(ended.status, 0) << ended.output;
    const nlohmann::json told = summary();
    EXPECT_EQ(told["steps"], end);
    EXPECT_EQ(told["edits"], 2);
    EXPECT_EQ(edits(), (std::vector<std::uint64_t>{1, 2})) << "no number is given twice";
    EXPECT_EQ(told["divergences"], 3) << "the divergences of the earlier runs must count, too";
    EXPECT_EQ(told["healed"], 2);
    EXPECT_EQ(told["outvoted"], 1);
    EXPECT_EQ(told["compared"]["first_difference"], 17);
    EXPECT_EQ(told["compared"]["frames_since"], 0);
    EXPECT_GT(told["frames_before"], 0);
    EXPECT_LT(told["frames_before"], told["frames"]);
    EXPECT_GT(told["steps_before"], 0);
    EXPECT_EQ(told["unhealed"], 0);
    EXPECT_EQ(told["haptic"]["reconnects"], 4);
    EXPECT_EQ(told["haptic"]["refused"]["servers"]["secret"], 7);
    EXPECT_EQ(told["journal"]["full_disk"]["times"], 1);
    EXPECT_EQ(json("out/incidents.json"), incidents);
    EXPECT_EQ(told["recoveries"], recoveries());
    EXPECT_EQ(told["recoveries"].size(), 2U);
    EXPECT_EQ(told["volume_final"], told["volume_initial"]);
    EXPECT_EQ(told["journal"]["policy"], "required");
    EXPECT_FALSE(std::filesystem::exists(journal().string() + ".previous"));
    EXPECT_EQ(told["state_hash"], replayedHash());
    const support::Ran verified = support::runProgram("sandwall-replay", journal().string() + " --verify");
    EXPECT_EQ(verified.status, 0) << verified.output;

    // A session cannot be resumed with another scene.
    const std::string other = write("other.toml",
                                    "name = \"other\"\n[field]\ncolumns = 128\nrows = 128\n[terrain]\n"
                                    "height = 0.2\n[material]\n[tool]\nradius = 0.04\n");
    expectOneLine(runToEnd({"--wall", wall(1, 2), "--scene", other, "--out", out(), "--resume", "--restarts", "0"}),
                  "other.toml: ");
}

// A large scene is compared while the session runs. Its sand comes from the journal, so nothing is lost.
TEST_F(Resuming, OfALargeFieldWithAnotherSceneEndsAsSoonAsTheScenesAreCompared) {
    const auto scene = [this](const std::string& height) {
        return write("level" + height + ".toml",
                     "name = \"level\"\n[field]\ncolumns = 2100\nrows = 2100\n[terrain]\nheight = " + height +
                         "\n[material]\n[tool]\nradius = 0.04\n");
    };
    const std::vector<std::string> words{"--wall", wall(1, 1), "--out", out(), "--no-pictures", "--restarts", "0"};
    const auto with = [&](std::initializer_list<std::string> more) {
        std::vector<std::string> all = words;
        all.insert(all.end(), more);
        return all;
    };
    ASSERT_EQ(runToEnd(with({"--scene", scene("0.1"), "--steps", "3"})).status, 0);
    const Ended other = runToEnd(with({"--scene", scene("0.2"), "--resume", "--frames", "100000"}));
    EXPECT_EQ(other.status, 2) << other.output;
    EXPECT_NE(other.output.find("level0.2.toml: is not the scene of the session in "), std::string::npos)
        << other.output;
    EXPECT_EQ(runToEnd(with({"--scene", scene("0.1"), "--resume", "--frames", "3"})).status, 0);
}

/// Untouched walls. The master numbers the steps, and pauses them while nothing moves.
class Rest : public SessionTest {
protected:
    /// Awaits the rest and returns the status that reports it.
    [[nodiscard]] nlohmann::json awaitRest() const {
        return awaitStatus([](const nlohmann::json& now) { return now.value("resting", false); });
    }
    [[nodiscard]] std::string journal() const { return out() + "/session.journal"; }
    [[nodiscard]] std::vector<journal::JournalRecord> records() const {
        journal::JournalReader reader = master::openJournal(journal());
        std::vector<journal::JournalRecord> all;
        while (auto record = reader.next()) {
            all.push_back(std::move(*record));
        }
        return all;
    }
    /// Sets the time of day of the master an hour ahead (tests/support/machine/other_clock.cpp).
    void setDateOfMasterAhead() {
        environment_ = {"LD_PRELOAD=" + support::linkTo("other-clock.so", folder_), "SANDWALL_CLOCK_RANK=0",
                        "SANDWALL_DATE_AHEAD=3600"};
    }
};

// The sand has rested for a second before frame 120 at 60 Hz. Frames may be later, but never earlier. A bit of a render
// rank flips in frame 120, and the audit finds it in one of the next frames, without a step.
TEST_F(Rest, AddsOneRecordToTheJournalAndHealsAFlippedBitWithoutAStep) {
    const Ended ended = runToEnd({"--wall", wall(1, 2, "mono"), "--scene", scene(), "--frames", "240", "--no-pictures",
                                  "--out", out(), "--inject", "diverge:rank=1,frame=120,bit=12"});
    ASSERT_EQ(ended.status, 0) << ended.output;
    EXPECT_TRUE(ended.has("healed", {{"rank", 1}})) << ended.output;
    const nlohmann::json told = summary();
    EXPECT_EQ(told["divergences"], 1);
    EXPECT_EQ(told["healed"], 1);
    EXPECT_EQ(told["frames"], 240);
    EXPECT_GT(told["held_seconds"]["rest"], 0);
    EXPECT_EQ(told["state_hash"], replayedHash());
    EXPECT_EQ(support::runProgram("sandwall-replay", journal() + " --verify").status, 0);
    const std::vector<journal::JournalRecord> all = records();
    const auto rest = std::find_if(all.begin(), all.end(), [](const journal::JournalRecord& record) {
        const auto* frame = std::get_if<journal::JournalFrame>(&record);
        return frame != nullptr && frame->steps.empty();
    });
    ASSERT_NE(rest, all.end());
    const auto& begun = std::get<journal::JournalFrame>(*rest);
    EXPECT_LT(begun.frame, 120U);
    EXPECT_EQ(fmt::format("{:016x}", begun.hashBefore), told["state_hash"]) << "of the sand that rested to the end";
    ASSERT_EQ(all.end() - rest, 4) << "the doubt about the majority, its check and the end follow";
    EXPECT_TRUE(std::holds_alternative<journal::JournalDoubt>(rest[1]));
    EXPECT_TRUE(std::holds_alternative<journal::JournalChecked>(rest[2]));
    EXPECT_EQ(std::get<journal::JournalEnd>(rest[3]).step, told["steps"]);
}

// The recovery takes seconds, and not the hour by which the master's time of day differs from the launcher's.
TEST_F(Rest, EndsWithNothingButAHandAnEditOrARestartWhichLosesNothing) {
    setDateOfMasterAhead();
    const auto session = start({"--wall", wall(1, 1, "mono"), "--scene", scene(), "--out", out(), "--no-pictures",
                                "--restarts", "100000", "--restart-window", "0.001"});
    expectFrames(*session);
    const nlohmann::json rested = awaitRest();
    const std::uintmax_t bytes = std::filesystem::file_size(journal());
    const nlohmann::json later =
        awaitStatus([&](const nlohmann::json& now) { return now.value("frame", 0) > rested.value("frame", 0) + 60; });
    EXPECT_EQ(later["step"], rested["step"]);
    EXPECT_EQ(later["state_hash"], rested["state_hash"]);
    EXPECT_EQ(std::filesystem::file_size(journal()), bytes);
    kill(support::findProgram(session->family(), "sandwall-master").value(), SIGKILL);
    const nlohmann::json recovered = session->waitForEvent("recovered")["recovery"];
    ASSERT_FALSE(recovered.is_null()) << session->output();
    EXPECT_EQ(recovered["checkpoint_step"].get<int>() + recovered["replayed_steps"].get<int>(), rested["step"])
        << "the first frame has a further step";
    EXPECT_GT(recovered["seconds_to_next_frame"], 0);
    EXPECT_LT(recovered["seconds_to_next_frame"], 3600);
    const nlohmann::json again = awaitRest();
    EXPECT_EQ(ask("settle")["step"], again.value("step", 0) + 1) << "the edit is in the next step";
    ask("stop");
    expectInOrder(*session);
    EXPECT_EQ(summary()["edits"], 1);
    EXPECT_EQ(summary()["state_hash"], replayedHash());
}

}  // namespace
