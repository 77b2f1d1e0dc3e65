// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "master/journal/journal.hpp"
#include "tests/cluster/session_fixture.hpp"
#include "tests/support/machine/small_disk.hpp"
#include "tests/support/processes/run_program.hpp"

namespace {

/// `sandwall ctl` on a running session.
class Operator : public SessionTest {
protected:
    void begin(const std::string& device, const std::string& stereo = "passive",
               const std::string& journal = "required") {
        beginOn(wall(1, 2, stereo), device, journal);
    }
    void beginOn(const std::string& wallFile, const std::string& device, const std::string& journal = "required") {
        beginOn(scene(), wallFile, device, journal);
    }
    void beginOn(const std::string& sceneFile, const std::string& wallFile, const std::string& device,
                 const std::string& journal) {
        session_ = start({"--wall", wallFile, "--scene", sceneFile, "--device", device, "--steps", "1000000", "--out",
                          out(), "--no-pictures", "--journal", journal});
        expectFrames(*session_);
        if (device != "none") {
            expectHand(*session_);
        }
    }
    /// The session must refuse the command `words`, with `named`, a value, in the error. The full error messages are
    /// tested beside the code, in tests/master/operator/control_test.cpp, tests/scene/material_test.cpp and
    /// tests/walls/stereo_change_test.cpp.
    void expectRefusal(const std::string& words, const std::string& named = "") {
        const nlohmann::json answered = answer(words);
        ASSERT_TRUE(answered.is_object()) << words;
        EXPECT_FALSE(answered.value("ok", true)) << words;
        const std::string error = answered.value("error", "");
        EXPECT_FALSE(error.empty()) << words;
        EXPECT_NE(error.find(named), std::string::npos) << words << ": " << error;
    }
    /// `sandwall ctl` must refuse the command `words` with status 2 and one line that contains `named`.
    void expectCtlRefusal(const std::string& words, const std::string& named) const {
        const support::Ran ran =
            support::runCommand(SANDWALL_SOURCE_DIR "/scripts/sandwall ctl " + out() + " " + words);
        expectOneLine({ran.status, ran.output}, named);
    }
    /// Stops the session and replays its journal.
    void endAndReplay(int edits) {
        ask("stop");
        expectInOrder(*session_);
        EXPECT_EQ(summary()["divergences"], 0);
        EXPECT_EQ(summary()["server_divergences"], 0);
        EXPECT_EQ(summary()["edits"], edits);
        EXPECT_EQ(summary()["volume_final"].get<std::int64_t>() + summary()["volume_outflow"].get<std::int64_t>(),
                  summary()["volume_initial"].get<std::int64_t>());
        EXPECT_EQ(summary()["state_hash"], replayedHash());
        EXPECT_FALSE(std::filesystem::exists(out() + "/control"));
    }
    /// The process that answers at the session's socket.
    [[nodiscard]] pid_t master() const {
        const int peer = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        const std::string path = out() + "/control";
        EXPECT_LT(path.size(), sizeof address.sun_path);
        path.copy(address.sun_path, sizeof address.sun_path - 1);
        ucred credentials{};
        socklen_t size = sizeof credentials;
        EXPECT_EQ(connect(peer, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
        EXPECT_EQ(getsockopt(peer, SOL_SOCKET, SO_PEERCRED, &credentials, &size), 0);
        close(peer);
        return credentials.pid;
    }
    /// Limits the size of every file that the master writes. The master then meets the errors of a full disk.
    void limitFiles(rlim_t bytes) const {
        rlimit limit{};
        ASSERT_EQ(prlimit(master(), RLIMIT_FSIZE, nullptr, &limit), 0);
        limit.rlim_cur = std::min(bytes, limit.rlim_max);
        ASSERT_EQ(prlimit(master(), RLIMIT_FSIZE, &limit, nullptr), 0);
    }
    [[nodiscard]] std::string heightsAfter(std::uint64_t step) const {
        const support::Ran ran =
            support::runProgram("sandwall-replay", out() + "/session.journal --until " + std::to_string(step) +
                                                       " --heights " + (folder_ / "heights.asc").string());
        EXPECT_EQ(ran.status, 0) << ran.output;
        return read("heights.asc");
    }
    std::unique_ptr<support::ChildProcess> session_;
};

/// Returns the step to whose sand the undo at step `undo` returns. It is the step before the last stroke, or the last
/// reset, load or undo within that stroke.
std::uint64_t keptBefore(const journal::Journal& journal, std::uint64_t undo) {
    std::uint64_t kept = 0;
    bool engaged = false;
    for (const journal::JournalFrame& frame : journal.frames) {
        for (const sand::Step& step : frame.steps) {
            if (step.number <= undo && step.engaged && !engaged) {
                kept = step.number - 1;
            } else if (step.number < undo && step.engaged &&
                       (step.edit.kind == sand::Edit::reset || step.edit.kind == sand::Edit::load ||
                        step.edit.kind == sand::Edit::undo)) {
                kept = step.number;
            }
            engaged = step.engaged;
        }
    }
    return kept;
}

/// Returns how many words of two texts differ. The texts have the same number of words, and not none.
int differences(const std::string& a, const std::string& b) {
    const auto wordsOf = [](const std::string& text) {
        std::istringstream stream(text);
        return std::vector<std::string>(std::istream_iterator<std::string>(stream), {});
    };
    const std::vector<std::string> ofA = wordsOf(a), ofB = wordsOf(b);
    EXPECT_FALSE(ofA.empty());
    EXPECT_EQ(ofA.size(), ofB.size());
    int count = 0;
    for (std::size_t i = 0; i < std::min(ofA.size(), ofB.size()); ++i) {
        count += ofA[i] == ofB[i] ? 0 : 1;
    }
    return count;
}

/// Returns strokes of a tenth of a second each. Together they last longer than any test, even on a slow machine.
std::string shortStrokes() {
    std::string text = "speed 2\ntravel 4\n";
    for (int i = 0; i < 2000; ++i) {
        text += fmt::format("stroke\npoint -0.1 {0}\npoint 0.1 {0}\n", 0.05 * (i % 10));
    }
    return text;
}

// Uses every command that changes sand, on a whole wall, while a hand digs. Then replays the session from its journal
// alone.
TEST_F(Operator, ChangesToolMaterialAndSandOfTwelveRanksAndAReplayEndsInTheSameHash) {
    beginOn(wall(3, 4, "anaglyph"), "script:" + write("short.strokes", shortStrokes()));
    const auto canUndo = [](const nlohmann::json& now) { return now.value("can_undo", false); };
    EXPECT_EQ(awaitStatus(canUndo)["ranks"], 12);
    const double radius = ask("status")["tool_radius"].get<double>() * 64;  // [cell] of a field 2 wide with 128 columns
    const auto cellsAtTool = static_cast<int>(16 * radius * radius);
    const std::size_t left = ask("undo")["undo_left"];
    // In or after a later stroke, so that the second undo returns to dug sand.
    awaitStatus([left](const nlohmann::json& now) { return now["undo_left"] > left; });
    EXPECT_EQ(ask("save dug-1")["file"], "saves/dug-1.sand");
    const std::uint64_t undone = ask("undo")["step"];
    ask("tool footprint radius=0.08 heading=60");
    ask("material talus 20");
    ask("material humidity 0.25");
    const nlohmann::json now = ask("status");
    EXPECT_TRUE(now["linked"]) << now;
    EXPECT_EQ(now["edits_waiting"], 0) << now;
    EXPECT_NEAR(now["tool_radius"].get<double>(), 0.08, 1e-3);
    EXPECT_EQ(now["tool_shape"], "footprint");
    EXPECT_NEAR(now["tool_heading"].get<double>(), 60, 0.01);
    EXPECT_EQ(now["material"]["talus"], 20);
    EXPECT_EQ(now["material"]["humidity"], 0.25);
    ask("settle");
    ask("reset");
    EXPECT_GT(ask("load dug-1")["step"], 0);
    ask("material talus 40");
    EXPECT_EQ(ask("status")["edits"], 9);
    EXPECT_EQ(ask("status")["server_divergences"], 0);
    std::filesystem::remove_all(folder_ / "out/saves");
    endAndReplay(9);
    const std::uint64_t kept = keptBefore(master::readJournal(out() + "/session.journal"), undone);
    ASSERT_GT(kept, 0U);
    // A tool that is in the sand presses once after the undo. So the sand at the tool may differ.
    EXPECT_LE(differences(heightsAfter(undone), heightsAfter(kept)), cellsAtTool)
        << "undone by step " << undone << ", as it was after step " << kept;

    support::ChildProcess film(
        {"/usr/bin/env", "-u", "DISPLAY", support::launcher(), "film", out() + "/session.journal", "--wall",
         wall(1, 1, "mono"), "--fps", "2", "--out", (folder_ / "film").string()},
        folder_ / "film.txt");
    EXPECT_EQ(film.wait(300), 0) << film.output();
    EXPECT_EQ(json("film/summary.json")["state_hash"], summary()["state_hash"]);
}

TEST_F(Operator, UndoesAndRedoesOnAllRanksAndAReplayEndsInTheSameHash) {
    beginOn(write("dunes.toml",
                  "[field]\ncolumns = 128\nrows = 96\nwidth = 2.0\n[terrain]\nkind = \"dunes\"\nheight = 0.3\n"
                  "dune_height = 0.2\ndune_length = 0.8\n[material]\ntalus_deg = 34\n[tool]\nradius = 0.04\n"),
            wall(1, 2, "passive"), "none", "required");
    std::vector<std::uint64_t> stops, undone, redone;  // steps; the sand of the stops is that before each command
    for (const char* command : {"material talus 12", "settle", "reset"}) {
        stops.push_back(ask(command)["step"].get<std::uint64_t>() - 1);
    }
    for (int left = 2; left >= 0; --left) {
        const nlohmann::json answered = ask("undo");
        undone.push_back(answered["step"]);
        EXPECT_EQ(answered["undo_left"], left);
        EXPECT_EQ(answered["redo_left"], 3 - left);
    }
    EXPECT_EQ(ask("status")["material"]["talus"], 34);
    EXPECT_EQ(ask("status")["can_undo"], false);
    expectRefusal("undo", "nothing to undo");
    stops.push_back(undone.front() - 1);
    for (int left = 2; left >= 0; --left) {
        const nlohmann::json answered = ask("redo");
        redone.push_back(answered["step"]);
        EXPECT_EQ(answered["redo_left"], left);
    }
    EXPECT_EQ(ask("status")["material"]["talus"], 12);
    expectRefusal("redo", "nothing to redo");
    endAndReplay(3 + 4 + 4);  // a change of the material is undone by two edits
    for (std::size_t i = 0; i < undone.size(); ++i) {
        EXPECT_EQ(heightsAfter(undone[i]), heightsAfter(stops[2 - i])) << "undo " << i;
        EXPECT_EQ(heightsAfter(redone[i]), heightsAfter(stops[i + 1])) << "redo " << i;
    }
    EXPECT_NE(heightsAfter(undone.back()), heightsAfter(undone[1])) << "the talus has moved sand";
}

TEST_F(Operator, ChangesWhatIsShownAndTakesPictures) {
    begin("none", "anaglyph");
    const auto picture = [this](int number, const char* name) {
        return read("out/capture_00" + std::to_string(number) + "/" + name);
    };
    EXPECT_EQ(ask("status")["stereo"], "anaglyph");
    EXPECT_EQ(ask("capture")["folder"], "capture_001");
    ask("stereo mono");
    EXPECT_EQ(ask("status")["stereo"], "mono");
    ask("capture");
    EXPECT_FALSE(picture(2, "wall.png").empty());
    EXPECT_TRUE(picture(2, "wall_left.png").empty()) << "mono has only one eye";
    ask("stereo anaglyph");
    EXPECT_EQ(ask("status")["pattern"], "none");
    ask("pattern grid");
    EXPECT_EQ(ask("status")["pattern"], "grid");
    ask("pattern next");
    EXPECT_EQ(ask("status")["pattern"], "tiles");
    ask("pattern none");
    ask("capture");
    for (const char* name : {"wall_left.png", "wall_right.png", "tile_r1c1_output.png", "tile_r1c2_output.png"}) {
        EXPECT_FALSE(picture(1, name).empty()) << name;
        EXPECT_EQ(picture(1, name), picture(3, name)) << name << " differs from the first capture";
    }
    EXPECT_NE(picture(1, "wall_left.png"), picture(1, "wall_right.png"));
    ask("eye-separation 0");
    awaitStatus([](const nlohmann::json& now) { return now.value("eye_separation", -1.0) == 0; });
    ask("capture");
    EXPECT_TRUE(picture(4, "wall_left.png") == picture(4, "wall_right.png")) << "both eyes are in one place";
    expectRefusal("stereo passive", "r1c1");
    expectRefusal("stereo side_by_side", "192x72");
    EXPECT_EQ(ask("status")["stereo"], "anaglyph");
    endAndReplay(0);
}

TEST_F(Operator, WithBestEffortAFolderThatFillsUpEndsTheJournalAndNotTheSession) {
    begin("none", "passive", "best-effort");
    limitFiles(64);
    EXPECT_GT(ask("settle")["step"], 0) << "sand that rests writes nothing";
    awaitStatus([](const nlohmann::json& now) { return !now.value("journal", true); });
    EXPECT_FALSE(session_->waitForEvent("journal", {{"state", "failed"}}).is_null()) << session_->output();
    expectRefusal("save full", "saves/full.sand");
    expectRefusal("capture", ".png");
    EXPECT_TRUE(std::filesystem::is_empty(folder_ / "out/saves"));
    limitFiles(RLIM_INFINITY);
    ask("save full");
    EXPECT_GT(ask("load full")["step"], 0);
    EXPECT_FALSE(ask("status")["journal"]);
    EXPECT_EQ(ask("status")["journal_state"], "failed");
    ask("stop");
    expectInOrder(*session_);
    EXPECT_EQ(summary()["divergences"], 0);
    const support::Ran replayed = support::runProgram("sandwall-replay", out() + "/session.journal");
    EXPECT_EQ(replayed.status, 0) << "the written part of the journal is damaged";
}

// The disk is smaller than the 1 MiB that the journal usually reserves at a time. So the sand stops with the next frame
// after the disk is full. It continues only when there is room for 1 MiB more than the next frame needs.
TEST_F(Operator, IsToldAtOnceThatTheSandStandsForWantOfRoomAndNothingIsDoneLater) {
    std::filesystem::create_directory(out());
    support::testOnSmallDisk(out(), "size=700k", [this] {
        begin("none");
        ask("settle");
        ask("save level");
        support::fill(out() + "/filler");
        const auto journalIs = [](const char* state) {
            return [state](const nlohmann::json& now) { return now.value("journal_state", "") == state; };
        };
        awaitStatus(journalIs("no_room"));
        for (const char* edit : {"settle", "material talus 20", "load level"}) {
            expectRefusal(edit);
        }
        EXPECT_NE(ask("status")["material"]["talus"], 20);
        std::filesystem::remove(out() + "/filler");
        support::resizeSmallDisk(out(), "size=4m");
        const nlohmann::json then = awaitStatus(journalIs("written"));
        EXPECT_EQ(then["edits_waiting"], 0);
        const auto goesOn = [&](const nlohmann::json& now) {
            return now.value("frame", 0) > then.value("frame", 0) + 9;
        };
        EXPECT_EQ(awaitStatus(goesOn)["edits"], 1) << "a refused edit was made later";
        EXPECT_GT(ask("settle")["step"], then.value("step", 0)) << "the sand continues";
        endAndReplay(2);
    });
}

TEST_F(Operator, SeesThatAFullDiskHasHeldTheHand) {
    std::filesystem::create_directory(out());
    support::testOnSmallDisk(out(), "size=700k", [this] {
        begin("script:gis");
        awaitStatus([](const nlohmann::json& now) { return now.value("step", 0) > 10; });
        support::fill(out() + "/filler");
        const nlohmann::json full =
            awaitStatus([](const nlohmann::json& now) { return now.value("journal_state", "") == "no_room"; });
        // The server's window of 8 steps is full after 8 frames. Later steps are withheld.
        awaitStatus([&](const nlohmann::json& now) { return now.value("frame", 0) > full.value("frame", 0) + 40; });
        std::filesystem::remove(out() + "/filler");  // the summary needs room, too
        ask("stop");
        EXPECT_TRUE(session_->wait(kLong).has_value()) << session_->output();
        const nlohmann::json told = summary();
        EXPECT_GT(told["held_seconds"]["disk"], 0);
        EXPECT_EQ(told["held_seconds"]["pause"], 0);
        EXPECT_GT(told["haptic"]["steps_withheld_by"]["disk"], 0) << told["haptic"];
        EXPECT_EQ(told["haptic"]["steps_withheld_by"]["pause"], 0) << told["haptic"];
        EXPECT_TRUE(told["journal"]["whole"]) << "no step was shown without the journal";
    });
}

// The paused session keeps its link: after it resumes, the server and its sand are the same.
TEST_F(Operator, PausesAHandAndTakesItUpAgain) {
    begin("script:gis");
    awaitStatus([](const nlohmann::json& now) { return now.value("step", 0) > 10; });
    ask("pause");
    const nlohmann::json paused = ask("status");
    EXPECT_TRUE(paused["paused"]);
    const auto later =
        awaitStatus([&](const nlohmann::json& now) { return now.value("frame", 0) > paused.value("frame", 0) + 60; });
    EXPECT_EQ(later["step"], paused["step"]) << "frames continue while the steps are paused";
    EXPECT_EQ(later["state_hash"], paused["state_hash"]);
    EXPECT_EQ(ask("settle")["waits_for"], "resume");
    EXPECT_EQ(ask("status")["edits_waiting"], 1);
    ask("resume");
    awaitStatus([&](const nlohmann::json& now) {
        return now.value("step", 0) > paused.value("step", 0) + 30 && now.value("edits", 0) == 1;
    });
    endAndReplay(1);
    EXPECT_GT(summary()["held_seconds"]["pause"], 0);
    EXPECT_EQ(summary()["held_seconds"]["disk"], 0);
    EXPECT_GT(summary()["haptic"]["steps_withheld_by"]["pause"], 0);
    EXPECT_EQ(summary()["haptic"]["steps_withheld_by"]["disk"], 0);
}

TEST_F(Operator, IsToldWhatCannotBeDoneAndTheSessionGoesOn) {
    begin("none");
    expectCtlRefusal("dance", "'dance'");
    for (const auto& [words, named] : {std::pair{"", "''"},
                                       {"undo", ""},
                                       {"undo twice", "'twice'"},
                                       {"redo", "redo"},
                                       {"pattern stripes", "'stripes'"},
                                       {"eye-separation -0.1", "'-0.1'"},
                                       {"eye-separation nan", "'nan'"},
                                       {"tool 0", "0"},
                                       {"tool 1e9", "1000000000"},
                                       {"tool footprint radius=7", "7"},
                                       {"tool wide", "'wide'"},
                                       {"material talus", "material"},
                                       {"material talus 90", "90"},
                                       {"material colour 3", "'colour'"},
                                       {"save ../elsewhere", "'../elsewhere'"},
                                       {"load never-saved", "never-saved.sand"}}) {
        expectRefusal(words, named);
    }
    EXPECT_EQ(ask("status")["divergences"], 0);
    endAndReplay(0);
    expectCtlRefusal("status", out());
}

TEST_F(Operator, IsToldWhereNoSessionIs) {
    expectCtlRefusal("status", out());
    std::filesystem::create_directory(out());
    expectCtlRefusal("status", out());
}

}  // namespace
