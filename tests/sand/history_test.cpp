// SPDX-License-Identifier: Apache-2.0
// Undo and redo of many strokes and edits: the sand at each stop is that on the way there.
#include "sand/history.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "tests/sand/history_session.hpp"
#include "tests/support/seed.hpp"

namespace {

using sand::Edit;
using sand::History;
using sand::Replica;
using Move = History::Move;
using Session = test::HistorySession;
using test::makeEntry;
using test::Stop;

class HistoryOf : public testing::TestWithParam<bool> {
protected:
    [[nodiscard]] static scene::Scene sceneOf(bool tin) { return tin ? test::tinScene() : test::gridScene(); }
    scene::Scene scene_ = sceneOf(GetParam());
};
INSTANTIATE_TEST_SUITE_P(GridAndTin, HistoryOf, testing::Bool(),
                         [](const auto& tin) { return tin.param ? "Tin" : "Grid"; });

TEST_P(HistoryOf, TwentyMixedEditsReturnsToEachStop) {
    const unsigned seed = test::randomSeed();
    SCOPED_TRACE(test::again(seed));
    std::mt19937 random(seed);
    Session session(scene_);
    const base::Bytes saved = session.replica().copySand()->encode();
    for (unsigned entry = 0; entry < History::kMost; ++entry) {
        ASSERT_NO_FATAL_FAILURE(makeEntry(session, entry, saved, random));
        ASSERT_NO_FATAL_FAILURE(session.otherTool(static_cast<std::int32_t>(2 + entry % 3) * sand::kProbePerCell));
        ASSERT_NO_FATAL_FAILURE(session.hover(static_cast<int>(random() % 3)));
        ASSERT_EQ(session.history().undosLeft(), session.undos()) << "entry " << entry;
    }
    ASSERT_EQ(session.history().undosLeft(), History::kMost);
    const Stop last = session.here();
    for (unsigned round = 0; round < 2; ++round) {
        for (std::size_t left = History::kMost; left > 0; --left) {
            ASSERT_TRUE(session.move(Move::undo, random)) << left;
            ASSERT_EQ(session.history().undosLeft(), left - 1);
            ASSERT_EQ(session.history().redosLeft(), History::kMost - left + 1);
            ASSERT_TRUE(session.here() == session.wanted()) << "undo with " << left << " left";
        }
        EXPECT_FALSE(session.move(Move::undo, random)) << "nothing is left";
        for (std::size_t left = History::kMost; left > 0; --left) {
            ASSERT_TRUE(session.move(Move::redo, random)) << left;
            ASSERT_EQ(session.history().redosLeft(), left - 1);
            ASSERT_TRUE(session.here() == session.wanted()) << "redo with " << left << " left";
        }
        EXPECT_FALSE(session.move(Move::redo, random)) << "nothing is left";
    }
    // Sand may have slid between the last step of the way there and the first undo.
    EXPECT_EQ(session.here().threshold, last.threshold);
}

// Sand slides between the moves, tools stay in the sand, and entries come between undos and redos.
TEST_P(HistoryOf, RandomMovesReturnsToEachStop) {
    const unsigned seed = test::randomSeed();
    SCOPED_TRACE(test::again(seed));
    for (unsigned round = 0; round < 4; ++round) {
        SCOPED_TRACE(round);
        std::mt19937 random(seed + round);
        Session session(scene_);
        const base::Bytes saved = session.replica().copySand()->encode();
        for (int i = 0; i < 60; ++i) {
            const bool wasEngaged = session.replica().engaged();
            const auto what = random() % 10;
            if (what < 4) {
                if (wasEngaged) {
                    ASSERT_NO_FATAL_FAILURE(session.hover(1));
                }
                ASSERT_NO_FATAL_FAILURE(makeEntry(session, static_cast<unsigned>(random() % 8), saved, random));
            } else if (what == 4 && !wasEngaged) {
                ASSERT_NO_FATAL_FAILURE(session.stroke(random, true));
            } else if (what == 5) {
                ASSERT_NO_FATAL_FAILURE(session.hover(1));
            } else {
                const Move move = what % 2 == 0 ? Move::undo : Move::redo;
                const std::size_t left = move == Move::undo ? session.undos() : session.redos();
                ASSERT_EQ(session.move(move, random), left > 0) << i;
                // A tool that is in the sand presses it again.
                ASSERT_TRUE(left == 0 || wasEngaged || session.here() == session.wanted()) << i;
            }
            ASSERT_EQ(session.history().undosLeft(), session.undos()) << i;
            ASSERT_EQ(session.history().redosLeft(), session.redos()) << i;
        }
    }
}

TEST_P(HistoryOf, ANewEntryEndsAllRedos) {
    std::mt19937 random(3);
    Session session(scene_);
    session.stroke(random);
    session.stroke(random);
    ASSERT_TRUE(session.move(Move::undo, random));
    ASSERT_EQ(session.history().redosLeft(), 1U);
    session.otherTool(3 * sand::kProbePerCell);
    EXPECT_EQ(session.history().redosLeft(), 1U) << "a change of the tool ends no redo";
    session.edit(Edit::settle);
    EXPECT_EQ(session.history().redosLeft(), 0U);
    EXPECT_FALSE(session.move(Move::redo, random));
    ASSERT_TRUE(session.move(Move::undo, random));
    EXPECT_TRUE(session.here() == session.wanted());
}

TEST_P(HistoryOf, TheNewestStrokeIsUndoneByTheEditUndo) {
    std::mt19937 random(4);
    Session session(scene_);
    session.stroke(random);
    session.stroke(random);
    EXPECT_EQ(session.history().beginReturn(session.replica(), Move::undo)->edit, Edit::undo);
    ASSERT_TRUE(session.move(Move::undo, random));
    EXPECT_EQ(session.history().beginReturn(session.replica(), Move::undo)->edit, Edit::load);
    session.stroke(random);
    session.edit(Edit::settle);
    EXPECT_EQ(session.history().beginReturn(session.replica(), Move::undo)->edit, Edit::load) << "of the settle";
}

// The tool rests in the sand, so that each undo goes one entry further back. When it moves, its stroke is an entry.
TEST_P(HistoryOf, AToolThatStaysInTheSandKeepsItsStroke) {
    std::mt19937 random(5);
    Session session(scene_);
    session.stroke(random);
    session.stroke(random);
    session.stroke(random, true);
    ASSERT_TRUE(session.move(Move::undo, random));
    EXPECT_EQ(session.history().undosLeft(), 2U);
    EXPECT_EQ(session.history().redosLeft(), 1U);
    sand::ProbePoint aside = session.replica().probe();
    aside.x += sand::kProbePerCell;
    session.apply({.engaged = true, .path = {aside}});
    EXPECT_EQ(session.history().undosLeft(), 3U);
    EXPECT_EQ(session.history().redosLeft(), 0U);
    ASSERT_TRUE(session.history().beginReturn(session.replica(), Move::undo));
    EXPECT_EQ(session.history().beginReturn(session.replica(), Move::undo)->edit, Edit::load);
}

TEST_P(HistoryOf, ALoadThatComesAfterANewStrokeIsAnEntry) {
    std::mt19937 random(6);
    Session session(scene_);
    session.edit(Edit::settle);
    const auto how = session.history().beginReturn(session.replica(), Move::undo);
    ASSERT_TRUE(how);
    (void)session.replica().continueCopy(1 << 20);
    session.stroke(random);
    const Stop after = session.here();
    session.apply({.edit = Edit::loaded(how->sand->encode())}, how->intent);
    EXPECT_EQ(session.history().undosLeft(), 3U) << "settle, stroke and load";
    const auto back = session.history().beginReturn(session.replica(), Move::undo);
    (void)session.replica().continueCopy(1 << 20);
    session.apply({.edit = Edit::loaded(back->sand->encode())}, back->intent);
    EXPECT_TRUE(session.here() == after) << "no sand is lost";
}

TEST_P(HistoryOf, AStrokeBetweenTheEditsOfAnUndoKnowsItsMaterial) {
    std::mt19937 random(6);
    Session session(scene_);
    session.material(1);
    const auto how = session.history().beginReturn(session.replica(), Move::undo);
    ASSERT_TRUE(how);
    ASSERT_EQ(how->label, 0U);
    session.tune(how->label, how->intent);
    session.stroke(random);
    EXPECT_EQ(session.history().beginReturn(session.replica(), Move::undo)->label, 0U);
}

TEST_P(HistoryOf, TheOldestEntriesGoWhenTheRecordsTakeTooMuchMemory) {
    std::mt19937 random(8);
    Session plain(scene_);
    for (int i = 0; i < 6; ++i) {
        plain.stroke(random);
    }
    const std::int64_t half = plain.history().bytes() / 2;
    ASSERT_GT(half, 0);
    random.seed(8);
    Session session(scene_, half);
    for (int i = 0; i < 6; ++i) {
        session.stroke(random);
    }
    const std::size_t left = session.history().undosLeft();
    EXPECT_GT(left, 0U);
    EXPECT_LT(left, 6U);
    EXPECT_LE(session.history().bytes(), half);
    // A redo takes memory, too, so that further old entries go.
    while (session.history().undosLeft() > 0) {
        ASSERT_TRUE(session.move(Move::undo, random));
        EXPECT_TRUE(session.here() == session.wanted());
        EXPECT_LE(session.history().bytes(), half);
    }
    EXPECT_FALSE(session.history().beginReturn(session.replica(), Move::undo));
}

// The sand before may have been wrong.
TEST_P(HistoryOf, AReplicaThatIsHealedForgetsItsEntries) {
    std::mt19937 random(9);
    Session session(scene_);
    session.stroke(random);
    session.edit(Edit::settle);
    session.replica().decodeState(session.replica().encodeState());
    EXPECT_FALSE(session.history().beginReturn(session.replica(), Move::undo));
    session.hover(1);
    EXPECT_EQ(session.history().undosLeft(), 1U) << "the replica keeps its stroke";
}

TEST_P(HistoryOf, AStrokeFromBeforeTheHistoryIsUndoneOnce) {
    std::mt19937 random(10);
    Session session(scene_);
    const Stop start = session.here();
    session.stroke(random);
    Replica resumed = session.replica();
    History later(resumed);
    ASSERT_EQ(later.undosLeft(), 1U);
    const auto how = later.beginReturn(resumed, Move::undo);
    ASSERT_TRUE(how);
    ASSERT_EQ(how->edit, Edit::undo);
    const sand::Step step{1, resumed.stepNumber() + 1, false, {}, Edit::undo};
    later.begin(resumed, step, how->intent, 0);
    resumed.apply(step);
    later.end(resumed);
    EXPECT_EQ(resumed.copySand()->encode(), start.sand);
    EXPECT_EQ(later.undosLeft(), 0U);
    EXPECT_EQ(later.redosLeft(), 0U);
    EXPECT_NE(later.version(), how->intent.version);
}

// Other replicas have no history.
TEST_P(HistoryOf, ChangesNoSand) {
    std::mt19937 random(11);
    Session session(scene_);
    session.stroke(random);
    Replica other = session.replica();
    const auto applyToBoth = [&](sand::Step step) {
        step.number = other.stepNumber() + 1;
        other.apply(step);
        session.apply(step);
        ASSERT_EQ(other.encodeState(), session.replica().encodeState());
    };
    for (int i = 0; i < 30; ++i) {
        sand::Step step = samples::randomStep(0, scene_.rules, random);
        step.sweeps = 0;
        step.edit = i % 7 == 3   ? Edit(Edit::settle)
                    : i % 7 == 5 ? Edit(Edit::reset)
                    : i % 7 == 6 ? Edit(Edit::undo)
                                 : Edit();
        ASSERT_NO_FATAL_FAILURE(applyToBoth(step)) << i;
    }
}

}  // namespace
