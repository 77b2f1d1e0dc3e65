// SPDX-License-Identifier: Apache-2.0
#include <sys/resource.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

#include "haptic_bridge/protocol.hpp"
#include "master/checkpoint.hpp"
#include "tests/cluster/session_fixture.hpp"
#include "tests/support/run_program.hpp"

namespace {

/// A session that stops and goes on.
class Resuming : public SessionTest {
protected:
    std::unique_ptr<support::ChildProcess> begin(const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"--wall",        wall(1, 2),     "--scene", scene(),      "--out", out(),
                                           "--no-pictures", "--checkpoint", "0.2",     "--restarts", "0"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        auto session = start(arguments);
        EXPECT_TRUE(session->waitForOutput("hashes agree", 120)) << session->output();
        return session;
    }
    nlohmann::json ask(const std::string& words) const {
        const support::Ran ran =
            support::runCommand(SANDWALL_SOURCE_DIR "/scripts/sandwall ctl " + out() + " " + words);
        EXPECT_EQ(ran.status, 0) << ran.output;
        return nlohmann::json::parse(ran.output, nullptr, false);
    }
    [[nodiscard]] std::filesystem::path journal() const { return folder_ / "out" / "session.journal"; }
    void awaitCheckpoint(std::uint64_t after) const {
        for (int i = 0; i < 600; ++i) {
            const auto steps = master::checkpointsOf(journal());
            if (!steps.empty() && steps.front() > after) {
                return;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
        }
        ADD_FAILURE() << "no checkpoint within half a minute";
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

// Killed, its journal torn; then refused by the disk; then to its end: one session, one journal, one sand.
TEST_F(Resuming, ASessionGoesOnWhereItStopped) {
    auto session = begin({});
    EXPECT_EQ(ask("tool ellipse radius=0.05 width=0.5")["ok"], true);
    const std::uint64_t tuned = ask("status")["step"];
    awaitCheckpoint(tuned);
    kill(masterOf(*session), SIGKILL);
    EXPECT_NE(session->wait(60).value_or(0), 0) << session->output();
    std::ofstream(journal(), std::ios::app | std::ios::binary) << "torn off";

    session = begin({"--resume"});
    EXPECT_NE(session->output().find("the last 8 bytes are no whole record and are cut off"), std::string::npos)
        << session->output();
    EXPECT_NE(session->output().find("sandwall: first frame "), std::string::npos) << session->output();
    const nlohmann::json status = ask("status");
    EXPECT_GT(status["step"], tuned);
    EXPECT_EQ(status["tool_shape"], "ellipse");
    EXPECT_EQ(status["edits"], 1);
    EXPECT_EQ(status["journal_policy"], "required");
    EXPECT_EQ(status["journal_state"], "written");
    // As the operator had it, not as the scene has it.
    EXPECT_EQ(ask("tool width=0.4")["ok"], true);
    EXPECT_NEAR(ask("status")["tool_radius"].get<double>(), 0.05, 1e-3);
    rlimit none{1, 1};
    ASSERT_EQ(prlimit(masterOf(*session), RLIMIT_FSIZE, &none, nullptr), 0);
    EXPECT_EQ(session->wait(60), 1) << session->output();
    EXPECT_NE(session->output().find("the journal cannot be written (File too large); it ends before frame "),
              std::string::npos)
        << session->output();

    const auto before = recoveries();
    ASSERT_EQ(before.size(), 1U);
    EXPECT_EQ(before[0]["cut_bytes"], 8);
    EXPECT_GT(before[0]["checkpoint_step"], 0);
    const std::uint64_t end = before[0]["step"].get<std::uint64_t>() + 400;
    nlohmann::json incidents{{"divergences", 3}, {"healed", 2},     {"server_divergences", 0},
                             {"links", 5},       {"reconnects", 4}, {"stands", 1}};
    for (const std::string_view kind : haptic_bridge::kRefusalNames) {
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
    EXPECT_EQ(told["divergences"], 3) << "what the tries before had healed counts too";
    EXPECT_EQ(told["healed"], 2);
    EXPECT_EQ(told["haptic"]["reconnects"], 4);
    EXPECT_EQ(told["haptic"]["refused"]["servers"]["secret"], 7);
    EXPECT_EQ(told["journal"]["full_disk"]["times"], 1);
    EXPECT_EQ(nlohmann::json::parse(read("out/incidents.json")), incidents);
    EXPECT_EQ(told["recoveries"], recoveries());
    EXPECT_EQ(told["recoveries"].size(), 2U);
    EXPECT_EQ(told["volume_final"], told["volume_initial"]);
    EXPECT_EQ(told["journal"]["policy"], "required");
    EXPECT_FALSE(std::filesystem::exists(journal().string() + ".previous"));
    const support::Ran replayed = support::runProgram("sandwall-replay", journal().string() + " --hash");
    EXPECT_EQ(replayed.output, told["state_hash"].get<std::string>() + "\n");
    const support::Ran verified = support::runProgram("sandwall-replay", journal().string() + " --verify");
    EXPECT_EQ(verified.status, 0) << verified.output;
    EXPECT_NE(verified.output.find("resumed      2 times, 8 bytes were cut off"), std::string::npos) << verified.output;

    // The scene is the session's, or it is another session.
    const std::string other = write("other.toml",
                                    "name = \"other\"\n[field]\ncolumns = 128\nrows = 128\n[terrain]\n"
                                    "height = 0.2\n[material]\n[tool]\nradius = 0.04\n");
    const Ended refused =
        runToEnd({"--wall", wall(1, 2), "--scene", other, "--out", out(), "--resume", "--restarts", "0"});
    EXPECT_EQ(refused.status, 2) << refused.output;
    EXPECT_NE(refused.output.find("other.toml: is not the scene of the session in"), std::string::npos)
        << refused.output;
}

}  // namespace
