// SPDX-License-Identifier: Apache-2.0
// Commands to the desk through its control socket, without a wall.
#include "master/operator/operator_desk.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <future>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/input_error.hpp"
#include "tests/master/operator/operator_desk_fixture.hpp"

namespace {

using base::Keystroke;
using nlohmann::json;

using Desk = test::OperatorDeskTest;

TEST_F(Desk, AnswersAnEditOnceItsStepIsShown) {
    std::future<json> answer = send("reset");
    obeyUntil([&] { return !edits().empty(); });
    EXPECT_EQ(edits()[0].kind, sand::Edit::reset);
    EXPECT_EQ(edits_.waiting().size(), 1U);
    EXPECT_EQ(answer.wait_for(std::chrono::milliseconds(20)), std::future_status::timeout) << "not shown yet";
    show(edits()[0]);
    EXPECT_EQ(await(answer), (json{{"ok", true}, {"step", 1}}));
    EXPECT_EQ(edits_.waiting().size(), 0U);
}

TEST_F(Desk, GivesEachEditANumberAndAnswersByIt) {
    std::future<json> first = send("settle");
    obeyUntil([&] { return edits().size() == 1; });
    std::future<json> second = send("settle");
    obeyUntil([&] { return edits().size() == 2; });
    EXPECT_EQ(edits()[0].number, 1U);
    EXPECT_EQ(edits()[1].number, 2U) << "it equals the first in all else";
    show(samples::withNumber(7, sand::Edit::settle));
    EXPECT_EQ(first.wait_for(std::chrono::milliseconds(20)), std::future_status::timeout) << "another edit was shown";
    show(edits()[0]);
    EXPECT_EQ(await(first), (json{{"ok", true}, {"step", 2}}));
    show(edits()[0]);
    EXPECT_EQ(second.wait_for(std::chrono::milliseconds(20)), std::future_status::timeout) << "a number twice";
    show(edits()[1]);
    EXPECT_EQ(await(second), (json{{"ok", true}, {"step", 4}}));
}

// An edit that waited when the session stopped is not in the journal, and its client is gone.
TEST_F(Desk, OfAResumedSessionCountsOnFromTheNumbersOfItsJournal) {
    edits_ = master::Edits(7);
    open(&force_);
    std::future<json> answer = send("reset");
    obeyUntil([&] { return !edits().empty(); });
    EXPECT_EQ(edits()[0].number, 8U);
    show(edits()[0]);
    EXPECT_EQ(await(answer)["ok"], true);
    EXPECT_EQ(ask("redo")["ok"], false);
    std::future<json> later = send("settle");
    obeyUntil([&] { return edits().size() == 2; });
    EXPECT_EQ(edits()[1].number, 9U) << "a refused edit takes no number";
    show(edits()[1]);
    EXPECT_EQ(await(later)["ok"], true);
}

TEST_F(Desk, SaysThatAnEditOfAPausedSessionWaits) {
    EXPECT_EQ(ask("pause"), (json{{"ok", true}}));
    EXPECT_TRUE(desk_->paused());
    EXPECT_EQ(ask("settle"), (json{{"ok", true}, {"waits_for", "resume"}}));
    EXPECT_EQ(edits_.waiting().size(), 1U);
    EXPECT_EQ(ask("resume"), (json{{"ok", true}}));
    EXPECT_FALSE(desk_->paused());
}

// If the disk is full, a new edit is refused. The client of an earlier edit gets the answer that the edit waits.
TEST_F(Desk, RefusesEditsForWhichTheDiskHasNoRoom) {
    std::future<json> before = send("reset");
    obeyUntil([&] { return !edits().empty(); });
    room_ = false;
    const json refused = ask("settle");
    EXPECT_EQ(refused["ok"], false);
    EXPECT_EQ(await(before), (json{{"ok", true}, {"waits_for", "room"}}));
    EXPECT_EQ(edits().size(), 1U);
    EXPECT_EQ(edits_.waiting().size(), 1U) << "the server may have it already";
    show(edits()[0]);
    EXPECT_EQ(edits_.waiting().size(), 0U);
}

TEST_F(Desk, RefusesSandThatIsTooLargeForTheDiskAndAnswersNobodyElse) {
    std::future<json> before = send("reset");
    obeyUntil([&] { return !edits().empty(); });
    ASSERT_EQ(ask("save large")["ok"], true);
    most_ = 8;  // no sand is so small
    EXPECT_EQ(ask("load large")["ok"], false);
    EXPECT_EQ(before.wait_for(std::chrono::milliseconds(20)), std::future_status::timeout) << "the sand is not stopped";
    show(edits()[0]);
    EXPECT_EQ(await(before), (json{{"ok", true}, {"step", 1}}));
}

TEST_F(Desk, RefusesWhatCannotBeDone) {
    for (const char* line : {"undo", "no such verb", "material talus 200", "tool hexagon", "load nothing"}) {
        const json answer = ask(line);
        EXPECT_EQ(answer["ok"], false) << line;
        EXPECT_FALSE(answer["error"].get<std::string>().empty()) << line;
    }
    EXPECT_TRUE(edits().empty());
}

// Several clients ask at once. Each undo starts from the sand of the one before.
TEST_F(Desk, UndoesAndRedoesOneAfterTheOther) {
    std::vector<base::Bytes> sand;
    const auto showNext = [&](std::size_t count) {
        obeyUntil([&] { return edits().size() == count; });
        show(edits().back());
    };
    for (const char* line : {"material talus 30", "settle", "reset"}) {
        sand.push_back(sand_.replica().copySand()->encode());
        std::future<json> answer = send(line);
        showNext(sand.size());
        EXPECT_EQ(await(answer)["ok"], true) << line;
    }
    EXPECT_EQ(sand_.history()->entries().undosLeft(), 3U);
    std::future<json> first = send("undo"), second = send("undo");
    showNext(4);
    EXPECT_EQ(edits()[3].kind, sand::Edit::load);
    showNext(5);
    std::vector<json> told{await(first), await(second)};
    std::ranges::sort(told, std::greater(), [](const json& one) { return one["undo_left"].get<int>(); });
    EXPECT_EQ(told[0], (json{{"ok", true}, {"step", 4}, {"undo_left", 2}, {"redo_left", 1}}));
    EXPECT_EQ(told[1], (json{{"ok", true}, {"step", 5}, {"undo_left", 1}, {"redo_left", 2}}));
    EXPECT_EQ(sand_.replica().copySand()->encode(), sand[1]);
    EXPECT_EQ(ask("status")["material"]["talus"], 30);
    std::future<json> third = send("undo");
    obeyUntil([&] { return edits().size() == 7; });
    EXPECT_EQ(edits()[5].kind, sand::Edit::tune) << "the talus of before";
    show(edits()[5]);
    show(edits()[6]);
    std::future<json> redo = send("redo");
    obeyUntil([&] { return edits().size() == 9; });
    EXPECT_EQ(await(third)["undo_left"], 0);
    EXPECT_EQ(ask("status")["material"]["talus"], 30) << "as it was asked for by the redo";
    show(edits()[7]);
    show(edits()[8]);
    EXPECT_EQ(await(redo)["redo_left"], 2);
}

TEST_F(Desk, AnswersWhenNothingIsLeftToUndoOrToRedo) {
    EXPECT_EQ(ask("undo"), (json{{"ok", false}, {"error", "nothing to undo"}}));
    EXPECT_EQ(ask("redo"), (json{{"ok", false}, {"error", "nothing to redo"}}));
    EXPECT_TRUE(edits().empty());
}

TEST_F(Desk, RefusesAnUndoForWhoseSandTheDiskHasNoRoom) {
    std::future<json> answer = send("settle");
    obeyUntil([&] { return edits().size() == 1; });
    show(edits()[0]);
    EXPECT_EQ(await(answer)["ok"], true);
    most_ = 8;  // no sand is so small
    const json refused = ask("undo");
    EXPECT_EQ(refused["ok"], false);
    EXPECT_EQ(edits().size(), 1U);
    EXPECT_EQ(sand_.history()->entries().undosLeft(), 1U) << "it is possible later";
    most_ = 1 << 30;
    std::future<json> again = send("undo");
    obeyUntil([&] { return edits().size() == 2; });
    show(edits()[1]);
    EXPECT_EQ(await(again)["undo_left"], 0);
}

TEST_F(Desk, RemembersTheMaterialThatWasAskedFor) {
    std::future<json> answer = send("material talus 30");
    obeyUntil([&] { return !edits().empty(); });
    ASSERT_EQ(edits()[0].kind, sand::Edit::tune);
    ASSERT_TRUE(edits_.waiting()[0].material) << "for the journal";
    EXPECT_EQ(edits_.waiting()[0].material->dryTalus, 30);
    show(edits()[0]);
    EXPECT_EQ(await(answer)["ok"], true);
    const json status = ask("status");
    EXPECT_EQ(status["material"]["talus"], 30);
    EXPECT_EQ(status["frame"], 42) << "the frame comes from the session";
    EXPECT_EQ(status["edits_waiting"], 0);
}

TEST_F(Desk, SavesTheSandAndLoadsItAgain) {
    EXPECT_EQ(ask("save one")["file"], "saves/one.sand");
    std::future<json> answer = send("load one");
    obeyUntil([&] { return !edits().empty(); });
    ASSERT_EQ(edits()[0].kind, sand::Edit::load);
    EXPECT_EQ(bytes_, static_cast<std::int64_t>(edits()[0].sand->size())) << "room for the whole sand";
    show(edits()[0]);
    EXPECT_EQ(await(answer)["ok"], true);
}

TEST_F(Desk, ChangesTheViewAndTheForce) {
    EXPECT_EQ(ask("pattern grid")["ok"], true);
    EXPECT_EQ(desk_->views().pattern(), lockstep::Pattern::grid);
    desk_->obey({{.key = {'t', 0, 0}}});
    EXPECT_EQ(desk_->views().pattern(), lockstep::nextPattern(lockstep::Pattern::grid)) << "a key in a window";
    EXPECT_EQ(ask("show hill-shade")["ok"], true);
    EXPECT_TRUE(desk_->views().layers().shows(lockstep::Overlay::hillShade));
    EXPECT_EQ(ask("hide hill-shade")["ok"], true);
    EXPECT_FALSE(desk_->views().layers().shows(lockstep::Overlay::hillShade));
    EXPECT_EQ(ask("stereo anaglyph")["ok"], true);
    EXPECT_EQ(desk_->shownWall().stereo, walls::Stereo::anaglyphColour);
    EXPECT_EQ(ask("eye-separation 0.07")["ok"], true);
    EXPECT_EQ(desk_->views().at(0).eyeSeparation, 0.07);
    EXPECT_TRUE(ask("status")["force_share"].is_null()) << "no operator has set it";
    EXPECT_EQ(ask("force scale 0.25")["ok"], true);
    EXPECT_EQ(force_.shares, std::vector<double>{0.25});
    EXPECT_EQ(kept_, std::vector<double>{0.25}) << "in the journal, too";
    EXPECT_EQ(ask("status")["force_share"], 0.25);
}

TEST_F(Desk, TellsTheCeilingOfTheServerBesideAShareAboveIt) {
    json told = ask("force on");
    EXPECT_TRUE(told["force_ceiling"].is_null()) << "no server is linked";
    EXPECT_FALSE(told.contains("note"));
    force_.ceiling = 0.25;
    told = ask("force on");
    EXPECT_EQ(told["ok"], true);
    EXPECT_EQ(told["force_share"], 1);
    EXPECT_EQ(told["force_ceiling"], 0.25);
    EXPECT_TRUE(told["note"].get<std::string>().starts_with("the hand feels 0.25 of the force")) << told;
    EXPECT_EQ(ask("status")["force_ceiling"], 0.25);
    EXPECT_FALSE(ask("force scale 0.25").contains("note"));
    force_.ceiling = 1;
    EXPECT_FALSE(ask("force on").contains("note"));
}

TEST_F(Desk, ShowsTheSandAsWetAsAnOperatorMakesIt) {
    EXPECT_EQ(desk_->views().at(0).humidity, 0);
    const std::future<json> answer = send("material humidity 0.3");
    obeyUntil([&] { return !edits().empty(); });
    EXPECT_EQ(desk_->views().at(0).humidity, 0.3);
    desk_->close();  // the client would wait for the step
}

TEST_F(Desk, ShowsTheSandAsWetAsTheSceneHasIt) {
    scene_.material.humidity = 0.6;
    open(&force_);
    EXPECT_EQ(desk_->views().at(0).humidity, 0.6);
}

TEST_F(Desk, KnowsTheShareOfTheForceFromBeforeARestart) {
    master::DeskOptions options;
    options.force = 0;
    open(&force_, options);
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

TEST_F(Desk, MakesNoFilmOfASessionWithoutAJournal) {
    master::OperatorDesk::SessionParts parts{sand_, edits_, &force_, {}, {}, {}, false};
    const std::filesystem::path out = folder_ / "other";
    std::filesystem::create_directory(out);
    master::OperatorDesk without(scene_, scene_.material, wall_, out, {}, parts);
    EXPECT_THROW(without.markFilm({}), base::InputError);
    EXPECT_EQ(ask("film")["film"], "begins") << "this one keeps a journal";
    EXPECT_EQ(ask("film")["ok"], false) << "no step was shown";
}

TEST_F(Desk, EndsAFilmWithTheSession) {
    EXPECT_EQ(ask("film")["film"], "begins");
    show(sand::Edit::reset);
    desk_->close();
    EXPECT_TRUE(std::filesystem::is_directory(folder_ / "film_001"));
}

TEST_F(Desk, EndsTheSessionByCommandOrByKey) {
    EXPECT_FALSE(desk_->stopAsked());
    EXPECT_EQ(ask("stop")["ok"], true);
    EXPECT_TRUE(desk_->stopAsked());
    open(nullptr);
    EXPECT_FALSE(desk_->stopAsked());
    desk_->obey({{.key = base::kCloseKey}});
    EXPECT_TRUE(desk_->stopAsked());
}

TEST_F(Desk, OfAReplayHasNoControlSocket) {
    open(nullptr);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "control"));
}

TEST_F(Desk, SwapsTheEyesUntilTheyAreSwappedBack) {
    using walls::Eye;
    const auto shown = [this] { return desk_->shownWall().tiles[0].outputs[0].eyes; };
    EXPECT_EQ(ask("status")["swap_eyes"], false);
    EXPECT_EQ(ask("swap-eyes on")["ok"], true);
    EXPECT_EQ(ask("status")["swap_eyes"], true);
    EXPECT_TRUE(desk_->views().at(0).swapEyes);
    EXPECT_EQ(shown(), (std::vector{Eye::right, Eye::left}));
    EXPECT_EQ(ask("stereo checkerboard")["ok"], true);
    EXPECT_EQ(shown(), (std::vector{Eye::right, Eye::left})) << "the glasses stay exchanged in another mode";
    EXPECT_EQ(ask("stereo left")["ok"], true);
    const json refused = ask("swap-eyes off");
    EXPECT_EQ(
        refused["error"],
        "swap-eyes: the wall shows one eye (left), so there is nothing to swap; choose a mode with two eyes first, "
        "such as stereo anaglyph");
    EXPECT_EQ(ask("stereo anaglyph")["ok"], true);
    EXPECT_EQ(ask("swap-eyes off")["ok"], true);
    EXPECT_FALSE(desk_->views().at(0).swapEyes);
    EXPECT_EQ(shown(), (std::vector{Eye::left, Eye::right}));
}

TEST_F(Desk, SwapsTheEyesAsTheWallFileHasIt) {
    wall_ = walls::withSwappedEyes(wall_, true);
    open(&force_);
    EXPECT_TRUE(desk_->views().at(0).swapEyes);
    EXPECT_EQ(ask("status")["swap_eyes"], true);
    EXPECT_EQ(ask("stereo anaglyph")["ok"], true);
    EXPECT_TRUE(desk_->views().at(0).swapEyes);
}

}  // namespace
