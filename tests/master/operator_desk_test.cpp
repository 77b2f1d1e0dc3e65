// SPDX-License-Identifier: Apache-2.0
// Commands to the desk through its control socket, without a wall.
#include "master/operator_desk.hpp"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <future>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "host/clock.hpp"
#include "tests/support/control_client.hpp"
#include "tests/support/folder_test.hpp"
#include "tests/support/no_steps.hpp"
#include "tests/support/sand_samples.hpp"

namespace {

using base::Keystroke;
using haptic_bridge::TimedStep;
using nlohmann::json;

constexpr Keystroke plain(char key) { return {static_cast<std::uint16_t>(key), 0, 0}; }
constexpr Keystroke control(char key) { return {static_cast<std::uint16_t>(key), Keystroke::kControl, 0}; }
constexpr Keystroke kShiftR{'r', Keystroke::kShift, 0};

/// Records the requests of the desk.
class Requests : public master::StepRequests {
public:
    void request(sand::Edit edit) override { edits.push_back(std::move(edit)); }
    void shareForce(double share) override { shares.push_back(share); }

    std::vector<sand::Edit> edits;
    std::vector<double> shares;
};

class Desk : public test::FolderTest {
protected:
    Desk() : Desk(samples::flatScene(32, 24)) {}
    explicit Desk(scene::Scene scene) : scene_(std::move(scene)) {}
    void SetUp() override { open(&requests_); }
    void open(master::StepRequests* requests, const master::DeskOptions& options = {}) {
        desk_.reset();
        desk_.emplace(scene_, scene_.material, wall_, folder_, options,
                      master::OperatorDesk::Session{sand_, requests,
                                                    [this](std::int64_t bytes) {
                                                        asked_ = bytes;
                                                        return room_ && bytes <= most_;
                                                    },
                                                    [this](double share) { kept_.push_back(share); },
                                                    [] {
                                                        return json{{"frame", 42}};
                                                    }});
    }
    void openForPointer() {
        master::DeskOptions options;
        options.pointer = true;
        open(&requests_, options);
    }
    /// Presses a key in the window of rank 1.
    void press(Keystroke key) {
        std::vector<lockstep::Arrival> arrivals(2);
        arrivals[1].key = key;
        desk_->obey(arrivals);
    }
    /// Returns the answer that the windows of a rank show.
    [[nodiscard]] std::string answerIn(int rank) {
        for (const lockstep::Answer& answer : desk_->answers(host::monotonicNs())) {
            if (answer.rank == rank) {
                return answer.text;
            }
        }
        return {};
    }
    /// Applies two steps with a stroke, so that there is one to undo.
    void stroke() {
        std::vector<TimedStep> steps(2);
        for (TimedStep& timed : steps) {
            timed.step.number = sand_.replica().stepNumber() + 1 + static_cast<std::uint64_t>(&timed - steps.data());
            timed.step.engaged = &timed != steps.data();
            timed.step.path = {sand::probePoint(16, 12, 0)};
        }
        sand_.apply(1, steps, 0, source_);
    }
    /// Sends a line from another thread. The future has the answer.
    std::future<json> send(const std::string& line) {
        return std::async(std::launch::async, [this, line] { return support::askSession(folder_, line); });
    }
    json await(std::future<json>& answer) {
        obeyUntil([&] { return answer.wait_for(std::chrono::milliseconds(1)) == std::future_status::ready; });
        return answer.get();
    }
    json ask(const std::string& line) {
        std::future<json> answer = send(line);
        return await(answer);
    }
    /// Calls obey() until `done`. After a minute it closes the desk, so that waiting clients return, and throws.
    void obeyUntil(const std::function<bool()>& done) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
        while (!done()) {
            if (std::chrono::steady_clock::now() > end) {
                desk_.reset();
                throw std::runtime_error("the desk did not do within a minute what this test waits for");
            }
            desk_->obey({});
        }
    }
    /// Shows a step with the edit `edit`.
    void show(const sand::Edit& edit) {
        std::vector<TimedStep> steps(1);
        steps[0].step.number = sand_.replica().stepNumber() + 1;
        steps[0].step.edit = edit;
        sand_.apply(1, steps, 0, source_);
        desk_->answer(steps);
    }

    scene::Scene scene_;
    walls::Wall wall_ = walls::loadWall(SANDWALL_SOURCE_DIR "/walls/configs/anaglyph_half.toml");
    master::MasterSand sand_{scene_, {}, {}};
    test::NoSteps source_;
    Requests requests_;
    bool room_ = true;
    std::vector<double> kept_;                   // shares of the force that the journal got
    std::int64_t most_ = std::int64_t{1} << 62;  // room on the disk [byte]
    std::int64_t asked_ = -1;
    std::optional<master::OperatorDesk> desk_;
};

TEST_F(Desk, AnswersAnEditOnceItsStepIsShown) {
    std::future<json> answer = send("reset");
    obeyUntil([&] { return !requests_.edits.empty(); });
    EXPECT_EQ(requests_.edits[0].kind, sand::Edit::reset);
    EXPECT_EQ(desk_->edits().size(), 1U);
    EXPECT_EQ(answer.wait_for(std::chrono::milliseconds(20)), std::future_status::timeout) << "not shown yet";
    show(requests_.edits[0]);
    EXPECT_EQ(await(answer), (json{{"ok", true}, {"step", 1}}));
    EXPECT_EQ(desk_->edits().size(), 0U);
}

TEST_F(Desk, GivesEachEditANumberAndAnswersByIt) {
    std::future<json> first = send("settle");
    obeyUntil([&] { return requests_.edits.size() == 1; });
    std::future<json> second = send("settle");
    obeyUntil([&] { return requests_.edits.size() == 2; });
    EXPECT_EQ(requests_.edits[0].number, 1U);
    EXPECT_EQ(requests_.edits[1].number, 2U) << "it equals the first in all else";
    show(samples::withNumber(7, sand::Edit::settle));
    EXPECT_EQ(first.wait_for(std::chrono::milliseconds(20)), std::future_status::timeout) << "another edit was shown";
    show(requests_.edits[0]);
    EXPECT_EQ(await(first), (json{{"ok", true}, {"step", 2}}));
    show(requests_.edits[0]);
    EXPECT_EQ(second.wait_for(std::chrono::milliseconds(20)), std::future_status::timeout) << "a number twice";
    show(requests_.edits[1]);
    EXPECT_EQ(await(second), (json{{"ok", true}, {"step", 4}}));
}

// An edit that waited when the session stopped is not in the journal, and its client is gone.
TEST_F(Desk, OfAResumedSessionCountsOnFromTheNumbersOfItsJournal) {
    master::DeskOptions options;
    options.lastEdit = 7;
    open(&requests_, options);
    std::future<json> answer = send("reset");
    obeyUntil([&] { return !requests_.edits.empty(); });
    EXPECT_EQ(requests_.edits[0].number, 8U);
    show(requests_.edits[0]);
    EXPECT_EQ(await(answer)["ok"], true);
    EXPECT_EQ(ask("undo")["ok"], false);
    std::future<json> later = send("settle");
    obeyUntil([&] { return requests_.edits.size() == 2; });
    EXPECT_EQ(requests_.edits[1].number, 9U) << "a refused edit takes no number";
    show(requests_.edits[1]);
    EXPECT_EQ(await(later)["ok"], true);
}

TEST_F(Desk, SaysThatAnEditOfAPausedSessionWaits) {
    EXPECT_EQ(ask("pause"), (json{{"ok", true}}));
    EXPECT_TRUE(desk_->paused());
    EXPECT_EQ(ask("settle"), (json{{"ok", true}, {"waits_for", "resume"}}));
    EXPECT_EQ(desk_->edits().size(), 1U);
    EXPECT_EQ(ask("resume"), (json{{"ok", true}}));
    EXPECT_FALSE(desk_->paused());
}

// If the disk is full, a new edit is refused. The client of an earlier edit gets the answer that the edit waits.
TEST_F(Desk, RefusesEditsForWhichTheDiskHasNoRoom) {
    std::future<json> before = send("reset");
    obeyUntil([&] { return !requests_.edits.empty(); });
    room_ = false;
    const json refused = ask("settle");
    EXPECT_EQ(refused["ok"], false);
    EXPECT_EQ(await(before), (json{{"ok", true}, {"waits_for", "room"}}));
    EXPECT_EQ(requests_.edits.size(), 1U);
    EXPECT_EQ(desk_->edits().size(), 1U) << "the server may have it already";
    show(requests_.edits[0]);
    EXPECT_EQ(desk_->edits().size(), 0U);
}

TEST_F(Desk, RefusesSandThatIsTooLargeForTheDiskAndAnswersNobodyElse) {
    std::future<json> before = send("reset");
    obeyUntil([&] { return !requests_.edits.empty(); });
    ASSERT_EQ(ask("save large")["ok"], true);
    most_ = 8;  // no sand is so small
    EXPECT_EQ(ask("load large")["ok"], false);
    EXPECT_EQ(before.wait_for(std::chrono::milliseconds(20)), std::future_status::timeout) << "the sand is not stopped";
    show(requests_.edits[0]);
    EXPECT_EQ(await(before), (json{{"ok", true}, {"step", 1}}));
}

TEST_F(Desk, RefusesWhatCannotBeDone) {
    for (const char* line : {"undo", "no such verb", "material talus 200", "load nothing"}) {
        const json answer = ask(line);
        EXPECT_EQ(answer["ok"], false) << line;
        EXPECT_FALSE(answer["error"].get<std::string>().empty()) << line;
    }
    EXPECT_TRUE(requests_.edits.empty());
}

TEST_F(Desk, RemembersTheMaterialThatWasAskedFor) {
    std::future<json> answer = send("material talus 30");
    obeyUntil([&] { return !requests_.edits.empty(); });
    ASSERT_EQ(requests_.edits[0].kind, sand::Edit::tune);
    sand::Step step;
    step.edit = requests_.edits[0];
    ASSERT_EQ(desk_->edits().materialsOf({step}).size(), 1U) << "for the journal";
    show(requests_.edits[0]);
    EXPECT_EQ(await(answer)["ok"], true);
    const json status = ask("status");
    EXPECT_EQ(status["material"]["talus"], 30);
    EXPECT_EQ(status["frame"], 42) << "the frame comes from the session";
    EXPECT_EQ(status["edits_waiting"], 0);
}

TEST_F(Desk, SavesTheSandAndLoadsItAgain) {
    EXPECT_EQ(ask("save one")["file"], "saves/one.sand");
    std::future<json> answer = send("load one");
    obeyUntil([&] { return !requests_.edits.empty(); });
    ASSERT_EQ(requests_.edits[0].kind, sand::Edit::load);
    EXPECT_EQ(asked_, static_cast<std::int64_t>(requests_.edits[0].sand->size())) << "room for the whole sand";
    show(requests_.edits[0]);
    EXPECT_EQ(await(answer)["ok"], true);
}

TEST_F(Desk, ChangesTheViewAndTheForce) {
    EXPECT_EQ(ask("pattern grid")["ok"], true);
    EXPECT_EQ(desk_->views().pattern(), lockstep::Pattern::grid);
    desk_->obey({{.key = plain('t')}});
    EXPECT_EQ(desk_->views().pattern(), lockstep::nextPattern(lockstep::Pattern::grid)) << "a key in a window";
    EXPECT_EQ(ask("show hill-shade")["ok"], true);
    EXPECT_TRUE(desk_->views().layers().shows(lockstep::Overlay::hillShade));
    EXPECT_EQ(ask("hide hill-shade")["ok"], true);
    EXPECT_FALSE(desk_->views().layers().shows(lockstep::Overlay::hillShade));
    EXPECT_EQ(ask("stereo anaglyph")["ok"], true);
    EXPECT_EQ(desk_->shownWall().stereo, walls::Stereo::anaglyphColour);
    EXPECT_TRUE(ask("status")["force_share"].is_null()) << "no operator has set it";
    EXPECT_EQ(ask("force scale 0.25")["ok"], true);
    EXPECT_EQ(requests_.shares, std::vector<double>{0.25});
    EXPECT_EQ(kept_, std::vector<double>{0.25}) << "in the journal, too";
    EXPECT_EQ(ask("status")["force_share"], 0.25);
}

TEST_F(Desk, ShowsTheSandAsWetAsAnOperatorMakesIt) {
    EXPECT_EQ(desk_->views().at(0).humidity, 0);
    const std::future<json> answer = send("material humidity 0.3");
    obeyUntil([&] { return !requests_.edits.empty(); });
    EXPECT_EQ(desk_->views().at(0).humidity, 0.3);
    desk_->close();  // the client would wait for the step
}

TEST_F(Desk, ShowsTheSandAsWetAsTheSceneHasIt) {
    scene_.material.humidity = 0.6;
    open(&requests_);
    EXPECT_EQ(desk_->views().at(0).humidity, 0.6);
}

TEST_F(Desk, KnowsTheShareOfTheForceFromBeforeARestart) {
    master::DeskOptions options;
    options.force = 0;
    open(&requests_, options);
    EXPECT_EQ(ask("status")["force_share"], 0);
    EXPECT_TRUE(kept_.empty()) << "the journal has it already";
}

TEST_F(Desk, WantsACaptureOfTheNextFrame) {
    EXPECT_FALSE(desk_->needsCapture());
    std::future<json> answer = send("capture");
    obeyUntil([&] { return desk_->needsCapture(); });
    desk_->close();  // no desk takes the line, and the connection ends
    EXPECT_TRUE(answer.get().is_discarded());
}

TEST_F(Desk, EndsTheSessionByCommandOrByEscape) {
    EXPECT_FALSE(desk_->stopAsked());
    EXPECT_EQ(ask("stop")["ok"], true);
    EXPECT_TRUE(desk_->stopAsked());
    open(nullptr);
    EXPECT_FALSE(desk_->stopAsked());
    desk_->obey({{.key = {Keystroke::kEscape, 0, 0}}});
    EXPECT_TRUE(desk_->stopAsked());
}

TEST_F(Desk, TakesKeysIfTheHandIsThePointer) {
    desk_->obey({{.key = kShiftR}, {.key = plain('h')}});
    EXPECT_TRUE(requests_.edits.empty()) << "another hand";
    EXPECT_FALSE(desk_->views().layers().shows(lockstep::Overlay::help));
    openForPointer();
    press(kShiftR);
    press(plain('h'));
    ASSERT_EQ(requests_.edits.size(), 1U);
    EXPECT_EQ(requests_.edits[0].kind, sand::Edit::reset);
    EXPECT_TRUE(desk_->views().layers().shows(lockstep::Overlay::help));
    press(plain('3'));
    press({Keystroke::kF1, 0, 0});
    ASSERT_EQ(requests_.edits.size(), 2U);
    EXPECT_EQ(requests_.edits[1].tuning.tool.kind, sand::ToolKind::rectangle);
    EXPECT_FALSE(desk_->views().layers().shows(lockstep::Overlay::help));
    press(control('z'));
    EXPECT_EQ(requests_.edits.size(), 2U) << "there is no stroke to undo";
    press(plain('x'));
    EXPECT_EQ(requests_.edits.size(), 2U) << "a key without an action";
}

TEST_F(Desk, UndoesTheLastStrokeByControlZAndByU) {
    openForPointer();
    stroke();
    press(control('z'));
    ASSERT_EQ(requests_.edits.size(), 1U);
    EXPECT_EQ(requests_.edits[0].kind, sand::Edit::undo);
    press(plain('u'));
    EXPECT_EQ(requests_.edits.size(), 2U) << "asked for before the first one is shown";
}

TEST_F(Desk, AnswersEachKeyInTheWindowWhereItWasPressed) {
    openForPointer();
    EXPECT_EQ(answerIn(0), lockstep::hint());
    press(control('z'));
    EXPECT_EQ(answerIn(1), "nothing to undo");
    stroke();
    press(control('z'));
    EXPECT_EQ(answerIn(1), "undone");
    press(plain('3'));
    EXPECT_EQ(answerIn(1), "tool: rectangle");
    press(plain('.'));
    EXPECT_EQ(answerIn(1), "heading 355°");
    press(plain('w'));
    EXPECT_EQ(answerIn(1), "humidity 10 %");
    press(plain('0'));
    EXPECT_EQ(answerIn(1), "tool, depth and humidity of the scene");
    press(plain(' '));
    EXPECT_EQ(answerIn(1), "paused; Space resumes");
    press(plain('1'));
    EXPECT_EQ(answerIn(1), "tool: sphere; the sand waits until Space resumes");
    press(plain(' '));
    EXPECT_EQ(answerIn(1), "resumed");
    press(plain('m'));
    EXPECT_EQ(answerIn(1), "hill-shade shown");
    press({Keystroke::kHome, 0, 0});
    EXPECT_EQ(answerIn(1), "this wall's view is fixed");
    press(control('s'));
    desk_->close();
    EXPECT_EQ(answerIn(1), "sand saved as saves/save_001.sand");
    EXPECT_EQ(answerIn(2), "");
    EXPECT_EQ(answerIn(0), lockstep::hint()) << "answers of one window leave it to the others";
}

TEST_F(Desk, OfAnotherHandHintsAtNothing) { EXPECT_TRUE(desk_->answers(host::monotonicNs()).empty()); }

TEST_F(Desk, PausesAndResumesBySpace) {
    openForPointer();
    press(plain(' '));
    EXPECT_TRUE(desk_->paused());
    press(plain(' '));
    EXPECT_FALSE(desk_->paused());
}

TEST_F(Desk, SavesByControlSUnderTheNextFreeName) {
    openForPointer();
    std::filesystem::create_directory(folder_ / "saves");
    std::ofstream(folder_ / "saves/save_002.sand") << "of an earlier session";
    press(control('s'));
    press(control('s'));
    desk_->close();
    EXPECT_TRUE(std::filesystem::exists(folder_ / "saves/save_001.sand"));
    EXPECT_TRUE(std::filesystem::exists(folder_ / "saves/save_003.sand"));
    EXPECT_EQ(std::filesystem::file_size(folder_ / "saves/save_002.sand"), 21U) << "that of an earlier session";
}

TEST_F(Desk, WantsACaptureByF12) {
    openForPointer();
    press({Keystroke::kF12, 0, 0});
    EXPECT_TRUE(desk_->needsCapture());
}

TEST_F(Desk, ChangesTheToolByKeysWithinItsLimitsAndBackToTheScene) {
    openForPointer();
    for (int i = 0; i < 60; ++i) {  // the scene's tool is smaller than both limits
        press(plain(i < 40 ? '+' : '-'));
        show(requests_.edits.back());
        const std::int32_t most = 3 * sand::kProbePerCell;  // a quarter of 24 cells long
        EXPECT_LE(requests_.edits.back().tuning.tool.radius, most);
        EXPECT_TRUE(i != 39 || requests_.edits.back().tuning.tool.radius == most);
    }
    EXPECT_EQ(requests_.edits.back().tuning.tool.radius, sand::kProbePerCell) << "two cells long";
    press(plain('4'));
    show(requests_.edits.back());
    press(plain(','));
    show(requests_.edits.back());
    const sand::Heading left = requests_.edits.back().tuning.tool.heading;
    EXPECT_EQ(left, sand::headingOf(5).value());
    press(plain('w'));
    show(requests_.edits.back());
    EXPECT_NE(requests_.edits.back().tuning, scene::tuningOf(scene_.material, scene_.grid()));
    press(plain('0'));
    EXPECT_EQ(requests_.edits.back().tuning, scene::tuningOf(scene_.material, scene_.grid()));
}

TEST_F(Desk, ChangesDepthAndSizeByTheWheelWithinTheirLimits) {
    openForPointer();
    std::array<haptic_bridge::PointerReport, 2> pointers{};
    desk_->turnWheels(pointers);
    EXPECT_TRUE(requests_.edits.empty()) << "a wheel that rests";
    pointers[1].depth = 2;
    desk_->turnWheels(pointers);
    EXPECT_NEAR(desk_->depth(), 0.7, 1e-12);
    EXPECT_EQ(answerIn(1), "depth 70 % of the radius");
    pointers[1].depth = -100;
    desk_->turnWheels(pointers);
    EXPECT_EQ(desk_->depth(), master::kShallowest);
    EXPECT_EQ(answerIn(1), "depth 10 % of the radius, the shallowest");
    press(plain('0'));
    EXPECT_EQ(desk_->depth(), master::kUsualDepth);
    pointers[1] = {};
    pointers[1].size = -100;
    desk_->turnWheels(pointers);
    EXPECT_EQ(requests_.edits.back().tuning.tool.radius, 3 * sand::kProbePerCell) << "away from the user is larger";
}

// The wall of these tests is in stereo, so that it is not a desktop.
TEST_F(Desk, KeepsTheViewOfAWallThatIsNoDesktop) {
    std::array<haptic_bridge::PointerReport, 3> pointers{};
    const auto before = desk_->views().at(0).sceneToRoom;
    pointers[1].wheel = 3;
    desk_->moveView(pointers);
    EXPECT_EQ(pointers[1].wheel, 0);
    EXPECT_EQ(pointers[1].depth, 3) << "the wheel is the depth";
    pointers[2].turnX = 0.25F;
    EXPECT_TRUE(desk_->answers(host::monotonicNs()).empty());
    desk_->moveView(pointers);
    EXPECT_EQ(answerIn(2), "this wall's view is fixed");
    pointers[2] = {.pan = {0, 0.1F, 0}};
    desk_->moveView(pointers);
    EXPECT_EQ(desk_->views().at(0).sceneToRoom, before);
}

TEST_F(Desk, MovesTheViewOfADesktopAndFramesItAgain) {
    wall_ = walls::loadWall(SANDWALL_SOURCE_DIR "/walls/configs/desktop.toml");
    master::DeskOptions options;
    options.pointer = true;
    open(&requests_, options);
    const auto framed = desk_->views().at(0).sceneToRoom;
    const std::array<haptic_bridge::PointerReport, 3> moves{
        {{.turnX = 0.25F}, {.wheel = 1, .wheelAt = {0, 1, 0}}, {.pan = {0.1F, 0, 0}}}};
    for (const haptic_bridge::PointerReport& move : moves) {
        std::array<haptic_bridge::PointerReport, 2> pointers{haptic_bridge::PointerReport{}, move};
        const auto before = desk_->views().at(0).sceneToRoom;
        desk_->moveView(pointers);
        EXPECT_NE(desk_->views().at(0).sceneToRoom, before);
        EXPECT_EQ(pointers[1].depth, 0);
    }
    press(plain('v'));
    EXPECT_EQ(desk_->views().at(0).sceneToRoom, framed);
}

/// Returns level sand with a high summit in the north-west corner.
scene::Scene mountain() {
    scene::Scene scene = samples::flatScene(32, 24);
    scene.terrain.setHeight(0, 23, scene.terrain.height(0, 23) + 40 * sand::kUnitsPerCell);
    return scene;
}

class MountainDesk : public Desk {
protected:
    MountainDesk() : Desk(mountain()) {}
};

TEST_F(MountainDesk, BeginsWithTheWholeTerrainInView) {
    wall_ = walls::loadWall(SANDWALL_SOURCE_DIR "/walls/configs/desktop.toml");
    const auto ofTheFile = master::ViewSource(wall_, scene_, {}).at(0).sceneToRoom;
    open(&requests_);
    EXPECT_LT(desk_->views().at(0).sceneToRoom[0], ofTheFile[0]) << "smaller than the wall file has it";
}

TEST_F(Desk, OfAReplayHasNoControlSocket) {
    open(nullptr);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "control"));
}

}  // namespace
