// SPDX-License-Identifier: Apache-2.0
#include "web/hand/dug_session.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "base/input_error.hpp"
#include "journal/journal.hpp"
#include "journal/memory_parts.hpp"
#include "journal/verification.hpp"
#include "tests/support/sand/sand_samples.hpp"

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

TEST_F(Dug, SaysWhenASettleComesNext) {
    stroke(8);
    EXPECT_FALSE(session_->settlesNext());
    session_->ask(sand::Edit::settle);
    EXPECT_TRUE(session_->settlesNext());
    advance(1);
    EXPECT_FALSE(session_->settlesNext());
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
