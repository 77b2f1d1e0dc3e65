// SPDX-License-Identifier: Apache-2.0
#include "web/hand/dug_session.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>

#include "base/input_error.hpp"
#include "journal/journal.hpp"
#include "journal/memory_parts.hpp"
#include "journal/memory_writer.hpp"
#include "journal/verification.hpp"
#include "tests/support/sand/sand_samples.hpp"
#include "web/hand/notches.hpp"

namespace {

constexpr std::int64_t kStepNs = 1'000'000'000 / 60;

/// Sand with a hand that looks straight down.
class Dug : public testing::Test {
protected:
    explicit Dug(std::int32_t sweepsPerStep = 4) {
        scene::Scene scene = samples::flatScene(64, 64, 6);
        scene.rules.tuning.sweepsPerStep = sweepsPerStep;
        scene.material.toolRadius = 6;
        session_ = std::make_unique<web::DugSession>(std::move(scene), 7, "1.2.3");
    }
    void point(double x, double y, bool pressed) {
        session_->point(now_, {{x, y, 1000}, {0, 0, -1}}, pressed);
        now_ += kStepNs;
    }
    /// Draws to the east, a cell a step, and lifts the tool.
    void stroke(int steps) {
        for (int i = 0; i < steps; ++i) {
            point(20 + i, 30, i + 1 < steps);
            (void)session_->advance();
        }
    }
    void advance(int steps) {
        for (int i = 0; i < steps; ++i) {
            (void)session_->advance();
        }
    }
    /// Returns a reader of the journal so far.
    journal::JournalReader journal() {
        std::vector<base::Bytes> parts;
        parts.push_back(session_->journal());
        return {std::make_unique<journal::MemoryParts>("JOURNAL", std::move(parts)), "1.2.3"};
    }
    /// Replays the journal. Returns its counts.
    journal::Verification::Counts replayed(std::uint64_t& hash) {
        journal::JournalReader reader = journal();
        journal::Verification verification("JOURNAL", sand::Replica(journal::sceneOf(reader)));
        while (const auto record = reader.next()) {
            verification.take(*record);
        }
        hash = verification.replica().stateHash();
        return verification.counts();
    }
    /// Returns the steps of the journal so far.
    std::vector<sand::Step> steps() {
        journal::JournalReader reader = journal();
        std::vector<sand::Step> all;
        for (const journal::JournalFrame& frame : journal::readAll(reader).frames) {
            all.insert(all.end(), frame.steps.begin(), frame.steps.end());
        }
        return all;
    }

    std::unique_ptr<web::DugSession> session_;
    std::int64_t now_ = kStepNs;
    std::uint64_t hash_ = 0;  // of a replay
};

/// Each step of its tool owes 150 sweeps.
class DugSlowly : public Dug {
protected:
    DugSlowly() : Dug(150) {}
};

TEST_F(Dug, ReplaysToTheSameSand) {
    stroke(20);
    session_->setNumber("talus", 20);
    session_->setTool({.kind = sand::ToolKind::ellipse, .heading = 30});
    advance(2);
    stroke(10);
    session_->ask(sand::Edit::undo);
    session_->ask(sand::Edit::settle);
    advance(5);
    std::uint64_t hash = 0;
    const journal::Verification::Counts counts = replayed(hash);
    EXPECT_EQ(hash, session_->replica().stateHash());
    EXPECT_EQ(counts.hashes, 38U);  // before each of 37 steps, and at the end
    EXPECT_EQ(counts.differing, 0U);
    EXPECT_EQ(counts.leftOut, 0U);
}

TEST_F(Dug, WritesTheMaterialBeforeTheStepThatSetsIt) {
    advance(3);
    session_->setNumber("humidity", 0.5);
    advance(2);
    journal::JournalReader reader = journal();
    const journal::Journal all = journal::readAll(reader);
    ASSERT_EQ(all.materials.size(), 1U);
    EXPECT_EQ(all.materials.front().frame, 3U);
    EXPECT_EQ(all.materials.front().material.humidity, 0.5);
    EXPECT_EQ(all.frames.at(3).steps.at(0).edit.kind, sand::Edit::tune);
}

TEST_F(Dug, GoesOnAfterItsJournalWasTaken) {
    stroke(5);
    const base::Bytes before = session_->journal();
    stroke(5);
    const base::Bytes after = session_->journal();
    EXPECT_GT(after.size(), before.size());
    std::uint64_t hash = 0;
    EXPECT_EQ(replayed(hash).differing, 0U);
    EXPECT_EQ(steps().size(), 10U);
}

/// Returns a session that continues with `journal`, before its steps are computed.
std::unique_ptr<web::DugSession> returning(base::Bytes journal) {
    std::vector<base::Bytes> parts;
    parts.push_back(std::move(journal));
    return std::make_unique<web::DugSession>(
        journal::JournalReader(std::make_unique<journal::MemoryParts>("KEPT", std::move(parts)), "1.2.3"), "1.2.3");
}
void returnAll(web::DugSession& session) {
    while (session.returnOn()) {
    }
}

TEST_F(Dug, ContinuesWithAKeptJournal) {
    stroke(20);
    session_->setNumber("humidity", 0.5);
    session_->setTool({.kind = sand::ToolKind::ellipse, .heading = 30});
    session_->ask(sand::Edit::settle);
    advance(4);
    stroke(10);
    const std::uint64_t hash = session_->replica().stateHash();
    auto kept = returning(session_->written());
    returnAll(*kept);
    EXPECT_EQ(kept->replica().stateHash(), hash);
    EXPECT_EQ(kept->shortcoming(), "");
    EXPECT_EQ(kept->written(), session_->written());
    EXPECT_EQ(kept->touched(), session_->touched());
    EXPECT_EQ(kept->material().humidity, 0.5);
    EXPECT_EQ(kept->material().toolKind, sand::ToolKind::ellipse);
    EXPECT_TRUE(kept->canUndo()) << "the last stroke";
    EXPECT_FALSE(kept->canRedo());
    session_ = std::move(kept);  // the same hand continues, and a native program replays all of it
    session_->ask(sand::Edit::undo);
    advance(2);
    EXPECT_FALSE(session_->replica().canUndo());
    stroke(10);
    EXPECT_EQ(replayed(hash_).differing, 0U);
    EXPECT_EQ(hash_, session_->replica().stateHash());
    EXPECT_EQ(replayed(hash_).leftOut, 0U);
}

// The undo may change the material, so a change that starts from the present one would bring it back.
TEST_F(Dug, RefusesAChangeOfTheMaterialWhileAnUndoWaits) {
    session_->setNumber("humidity", 0.5);
    advance(1);
    session_->ask(sand::Edit::undo);
    EXPECT_THROW(session_->setNumber("talus", 20), base::InputError);
    EXPECT_THROW(session_->setTool({.radius = 3}), base::InputError);
    advance(3);
    EXPECT_EQ(session_->material().humidity, 0) << "undone";
    session_->setNumber("talus", 20);
    advance(1);
    EXPECT_EQ(session_->material().humidity, 0);
}

TEST_F(Dug, LiftsTheToolOfAKeptStrokeFirst) {
    for (int i = 0; i < 10; ++i) {
        point(20 + i, 30, true);
        (void)session_->advance();
    }
    ASSERT_TRUE(session_->replica().engaged());
    session_ = returning(session_->written());
    returnAll(*session_);
    EXPECT_TRUE(session_->replica().engaged());
    point(50, 50, false);
    advance(3);
    EXPECT_FALSE(session_->replica().engaged());
    EXPECT_EQ(steps().at(10).path.size(), 0U) << "a furrow from the kept stroke to the pointer";
    EXPECT_EQ(replayed(hash_).differing, 0U);
}

TEST_F(Dug, ContinuesFromAKeptState) {
    stroke(20);
    const journal::JournalEnd at{session_->replica().stepNumber(), session_->replica().stateHash()};
    const base::Bytes state = session_->replica().encodeState();
    stroke(10);
    auto kept = returning(session_->written());
    kept->returnFrom(at, state);
    returnAll(*kept);
    EXPECT_EQ(kept->replica().stateHash(), session_->replica().stateHash());
    EXPECT_EQ(kept->written(), session_->written());

    auto damaged = returning(session_->written());
    base::Bytes broken = state;
    broken.resize(broken.size() / 2);
    damaged->returnFrom(at, broken);
    EXPECT_ANY_THROW(returnAll(*damaged));
    auto other = returning(session_->written());
    other->returnFrom({at.step, at.hash + 1}, state);
    EXPECT_ANY_THROW(returnAll(*other));
    auto later = returning(session_->written());
    later->returnFrom({at.step + 100, at.hash}, state);
    EXPECT_ANY_THROW(returnAll(*later));
}

TEST_F(Dug, ContinuesUpToTheDamageOfAKeptJournal) {
    stroke(20);
    base::Bytes bytes = session_->written();
    bytes.at(bytes.size() * 9 / 10) ^= 1;
    auto kept = returning(bytes);
    returnAll(*kept);
    EXPECT_NE(kept->shortcoming(), "");
    EXPECT_GT(kept->replica().stepNumber(), 2U);
    EXPECT_LT(kept->replica().stepNumber(), 20U);
    EXPECT_TRUE(std::equal(kept->written().begin(), kept->written().end(), session_->written().begin()));
}

TEST_F(Dug, RefusesToContinueWithASessionOfAWall) {
    journal::MemoryWriter writer(session_->scene(), 7, "wall", "1.2.3");
    writer.add(journal::JournalResumed{});
    auto kept = returning(writer.bytes());
    EXPECT_ANY_THROW(returnAll(*kept));
}

TEST_F(Dug, CountsWhatTheHandHasDone) {
    EXPECT_TRUE(session_->rests() || session_->replica().stepNumber() == 0);
    advance(3);
    EXPECT_TRUE(session_->rests());
    EXPECT_EQ(session_->touched(), 0U);
    session_->setTool({.radius = 5});
    EXPECT_FALSE(session_->rests());
    advance(2);
    EXPECT_EQ(session_->touched(), 1U);
    EXPECT_FALSE(session_->dug()) << "a tool is no sand";
    stroke(5);
    EXPECT_TRUE(session_->dug());
    EXPECT_GT(session_->touched(), 3U);
    const std::uint64_t touched = session_->touched();
    advance(200);
    EXPECT_EQ(session_->touched(), touched);
    EXPECT_TRUE(session_->rests());
}

TEST_F(DugSlowly, SpreadsItsSweepsInPartsOf64AndHoldsTheTool) {
    stroke(30);
    advance(20);
    int owing = 0;
    bool moved = false;
    for (const sand::Step& step : steps()) {
        EXPECT_LE(step.sweeps, 64) << step.number;
        owing += step.sweeps == 64 ? 1 : 0;
        moved = moved || !step.path.empty();
    }
    EXPECT_TRUE(moved);
    EXPECT_GT(owing, 4);  // 150 are 64, 64 and 22
    std::uint64_t hash = 0;
    EXPECT_EQ(replayed(hash).leftOut, 0U);
}

TEST_F(Dug, DigsAsDeepAsItIsTold) {
    session_->setDepth(0.1);
    stroke(8);
    const double shallow = session_->replica().surface().height(23 * sand::kProbePerCell, 30 * sand::kProbePerCell);
    session_->ask(sand::Edit::reset);
    advance(2);
    session_->setDepth(1);
    stroke(8);
    EXPECT_LT(session_->replica().surface().height(23 * sand::kProbePerCell, 30 * sand::kProbePerCell), shallow);
    EXPECT_THROW(session_->setDepth(2.1), base::InputError);
    EXPECT_THROW(session_->setDepth(0), base::InputError);
}

TEST_F(Dug, LiftsAToolThatHoversToTheHeightForItsNewSize) {
    point(20, 30, false);
    advance(2);
    const auto above = [this] {
        const sand::ProbePoint probe = session_->replica().probe();
        return (probe.z -
                session_->replica().surface().height(probe.x, probe.y) * sand::kProbePerCell / sand::kUnitsPerCell) /
               session_->replica().tool().radius;
    };
    EXPECT_NEAR(above(), haptic_bridge::PointerHand::kHover, 0.01);
    session_->setTool({.radius = 10});
    advance(3);
    EXPECT_EQ(session_->replica().tool().radius, 10 * sand::kProbePerCell);
    EXPECT_NEAR(above(), haptic_bridge::PointerHand::kHover, 0.01);
}

// The page has no rules of its own for keys and the wheel.
TEST_F(Dug, ChangesToolAndHumidityByNotchesAsAWindowDoes) {
    const double cell = session_->scene().terrain.cellSize();
    const auto radius = [&] { return session_->material().toolRadius / cell; };
    session_->setTool({.radius = 2 * cell});
    web::changeByNotches(*session_, "size", 1);
    EXPECT_DOUBLE_EQ(radius(), 2.5);
    web::changeByNotches(*session_, "size", -2);
    EXPECT_DOUBLE_EQ(radius(), 1.6) << "the press before counts, although no step has come";
    web::changeByNotches(*session_, "size", 100);
    EXPECT_DOUBLE_EQ(radius(), 8) << "a quarter of 64 cells long";
    web::changeByNotches(*session_, "size", -100);
    EXPECT_DOUBLE_EQ(radius(), 1);
    web::enlargeTool(*session_);
    EXPECT_DOUBLE_EQ(radius(), 2) << "1/40 of 64 cells is less than two";
    session_->setTool({.radius = 5 * cell});
    web::enlargeTool(*session_);
    EXPECT_DOUBLE_EQ(radius(), 5);

    const double heading = session_->material().toolHeading;
    web::changeByNotches(*session_, "heading", 1);
    EXPECT_EQ(session_->material().toolHeading, heading) << "a sphere has none";
    advance(10);
    session_->setTool({.kind = sand::ToolKind::ellipse, .heading = 358});
    web::changeByNotches(*session_, "heading", 1);
    EXPECT_EQ(session_->material().toolHeading, 3);
    for (int i = 0; i < 3; ++i) {
        web::changeByNotches(*session_, "humidity", 1);
    }
    EXPECT_EQ(session_->material().humidity, 0.3);
    EXPECT_THROW(web::changeByNotches(*session_, "weight", 1), base::InputError);
}

TEST_F(Dug, SaysWhenASettleComesNext) {
    stroke(8);
    EXPECT_FALSE(session_->settlesNext());
    session_->ask(sand::Edit::settle);
    EXPECT_TRUE(session_->settlesNext());
    advance(1);
    EXPECT_FALSE(session_->settlesNext());
}

// The journal has the loads that undo and redo, and the material of before.
TEST_F(Dug, UndoesAndRedoesStrokesAndEdits) {
    std::vector<base::Bytes> stops;
    const auto keep = [&] { stops.push_back(session_->replica().copySand()->encode()); };
    const auto expectStop = [&](std::size_t stop) {
        EXPECT_TRUE(session_->replica().copySand()->encode() == stops[stop]) << stop;
    };
    advance(2);
    keep();
    stroke(10);
    advance(30);
    keep();
    session_->setNumber("talus", 20);
    advance(3);
    keep();
    session_->ask(sand::Edit::reset);
    advance(1);
    for (std::size_t stop = 3; stop-- > 0;) {
        ASSERT_TRUE(session_->canUndo());
        session_->ask(sand::Edit::undo);
        advance(stop == 1 ? 2 : 1);  // the material is an edit of its own
        expectStop(stop);
        EXPECT_EQ(session_->material().dryTalus, stop == 2 ? 20 : 34);
    }
    EXPECT_FALSE(session_->canUndo());
    EXPECT_THROW(session_->ask(sand::Edit::undo), base::InputError);
    session_->redo();
    session_->redo();
    advance(3);
    expectStop(2);
    EXPECT_EQ(session_->material().dryTalus, 20);
    session_->ask(sand::Edit::settle);
    session_->redo();  // the settle ends it
    advance(3);
    EXPECT_FALSE(session_->canRedo());
    EXPECT_THROW(session_->redo(), base::InputError);
    std::uint64_t hash = 0;
    EXPECT_EQ(replayed(hash).differing, 0U);
    EXPECT_EQ(hash, session_->replica().stateHash());
}

TEST_F(Dug, RefusesAnUndoWithoutAStroke) {
    EXPECT_THROW(session_->ask(sand::Edit::undo), base::InputError);
    point(20, 30, false);
    advance(3);
    EXPECT_THROW(session_->ask(sand::Edit::undo), base::InputError);
    stroke(3);
    session_->ask(sand::Edit::undo);
}

}  // namespace
