// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <functional>
#include <thread>

#include "tests/cluster/session_fixture.hpp"
#include "tests/support/run_program.hpp"

namespace {

/// `sandwall ctl` on a session that runs.
class Operator : public SessionTest {
protected:
    void begin(const std::string& device, const std::string& waitFor, const std::string& stereo = "passive") {
        session_ = start({"--wall", wall(1, 2, stereo), "--scene", scene(), "--device", device, "--steps", "1000000",
                          "--out", out(), "--no-pictures"});
        ASSERT_TRUE(session_->waitForOutput(waitFor, 120)) << session_->output();
    }
    [[nodiscard]] support::Ran ctl(const std::string& words) const {
        return support::runCommand(SANDWALL_SOURCE_DIR "/scripts/sandwall ctl " + out() + " " + words);
    }
    /// The answer to a command that must succeed.
    nlohmann::json ask(const std::string& words) {
        const support::Ran ran = ctl(words);
        EXPECT_EQ(ran.status, 0) << words << ": " << ran.output << session_->output();
        const nlohmann::json answer = nlohmann::json::parse(ran.output, nullptr, false);
        EXPECT_TRUE(answer.is_object() && answer.value("ok", false)) << words << ": " << ran.output;
        return answer.is_object() ? answer : nlohmann::json::object();
    }
    void expectRefusal(const std::string& words, const std::string& part) {
        const support::Ran ran = ctl(words);
        EXPECT_EQ(ran.status, 2) << words << ": " << ran.output;
        EXPECT_EQ(std::count(ran.output.begin(), ran.output.end(), '\n'), 1) << ran.output;
        EXPECT_NE(ran.output.find(part), std::string::npos) << ran.output;
    }
    /// Asks until the answer is as wanted; the session's own end is the limit.
    nlohmann::json awaitStatus(const std::function<bool(const nlohmann::json&)>& wanted) {
        for (int i = 0; i < 600; ++i) {
            const nlohmann::json now = ask("status");
            if (wanted(now) || HasFailure()) {
                return now;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
        }
        ADD_FAILURE() << "not within a minute: " << ask("status");
        return {};
    }
    /// Stops it, and replays what it did.
    void endAndReplay(int edits) {
        ask("stop");
        EXPECT_EQ(session_->wait(120), 0) << session_->output();
        EXPECT_EQ(summary()["divergences"], 0);
        EXPECT_EQ(summary()["server_divergences"], 0);
        EXPECT_EQ(summary()["edits"], edits);
        EXPECT_EQ(summary()["volume_final"].get<std::int64_t>() + summary()["volume_outflow"].get<std::int64_t>(),
                  summary()["volume_initial"].get<std::int64_t>());
        const support::Ran replayed = support::runProgram("sandwall-replay", out() + "/session.journal --hash");
        EXPECT_EQ(replayed.status, 0);
        EXPECT_EQ(replayed.output, summary()["state_hash"].get<std::string>() + "\n");
        EXPECT_FALSE(std::filesystem::exists(out() + "/control"));
    }
    std::unique_ptr<support::ChildProcess> session_;
};

TEST_F(Operator, EditsTheSandThatAHandDigs) {
    begin("script:gis", "hand linked");
    awaitStatus([](const nlohmann::json& now) { return now.value("can_undo", false); });
    EXPECT_GT(ask("settle")["step"], 0);
    awaitStatus([](const nlohmann::json& now) { return now.value("can_undo", false); });
    EXPECT_GT(ask("undo")["step"], 0);
    EXPECT_GT(ask("reset")["step"], 0);
    const nlohmann::json now = ask("status");
    EXPECT_TRUE(now["linked"]) << now;
    EXPECT_EQ(now["edits"], 3) << now;
    EXPECT_EQ(now["edits_waiting"], 0) << now;
    EXPECT_EQ(now["ranks"], 2);
    endAndReplay(3);
}

// The hand is waited for, not thrown away: the server is the same, and its sand the wall's.
TEST_F(Operator, PausesAHandAndTakesItUpAgain) {
    begin("script:gis", "hand linked");
    awaitStatus([](const nlohmann::json& now) { return now.value("step", 0) > 10; });
    ask("pause");
    const nlohmann::json paused = ask("status");
    EXPECT_TRUE(paused["paused"]);
    const auto later =
        awaitStatus([&](const nlohmann::json& now) { return now.value("frame", 0) > paused.value("frame", 0) + 60; });
    EXPECT_EQ(later["step"], paused["step"]) << "frames go on, steps do not";
    EXPECT_EQ(later["state_hash"], paused["state_hash"]);
    EXPECT_EQ(ask("settle")["waits_for"], "resume");
    EXPECT_EQ(ask("status")["edits_waiting"], 1);
    ask("resume");
    awaitStatus([&](const nlohmann::json& now) {
        return now.value("step", 0) > paused.value("step", 0) + 30 && now.value("edits", 0) == 1;
    });
    endAndReplay(1);
}

TEST_F(Operator, ChangesWhatIsShownAndTakesPictures) {
    begin("none", "no hand");
    EXPECT_EQ(ask("status")["pattern"], "none");
    EXPECT_EQ(ask("capture")["folder"], "capture_001");
    ask("pattern grid");
    EXPECT_EQ(ask("status")["pattern"], "grid");
    ask("pattern next");
    EXPECT_EQ(ask("status")["pattern"], "tiles");
    ask("pattern none");
    ask("eye-separation 0");
    awaitStatus([](const nlohmann::json& now) { return now.value("eye_separation", -1.0) == 0; });
    EXPECT_EQ(ask("capture")["folder"], "capture_002");
    for (const char* name : {"tile_r1c1_left.png", "tile_r1c2_right.png", "wall_left.png", "wall_anaglyph.png"}) {
        EXPECT_TRUE(std::filesystem::exists(folder_ / "out/capture_001" / name)) << name;
    }
    EXPECT_NE(read("out/capture_001/wall_left.png"), read("out/capture_001/wall_right.png"));
    EXPECT_EQ(read("out/capture_002/wall_left.png"), read("out/capture_002/wall_right.png")) << "eyes in one place";
    endAndReplay(0);
}

TEST_F(Operator, IsToldWhatCannotBeDoneAndTheSessionGoesOn) {
    begin("none", "no hand");
    expectRefusal("dance", "'dance' is no command; these are: status, pause");
    expectRefusal("", "'' is no command");
    expectRefusal("undo", "there is no stroke to undo");
    expectRefusal("undo twice", "undo takes no argument, got 'twice'");
    expectRefusal("pattern stripes", "no test pattern 'stripes'");
    expectRefusal("eye-separation -0.1", "eye-separation must be 0 to 0.5 metres, got '-0.1'");
    expectRefusal("eye-separation nan", "eye-separation must be 0 to 0.5 metres, got 'nan'");
    const nlohmann::json now = ask("status");
    EXPECT_EQ(now["divergences"], 0);
    endAndReplay(0);
    expectRefusal("status", "no session is running there");
}

TEST_F(Operator, IsToldWhereNoSessionIs) {
    expectRefusal("status", "cannot be opened");
    std::filesystem::create_directory(out());
    expectRefusal("status", "no session is running there");
}

}  // namespace
