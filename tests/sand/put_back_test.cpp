// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "host/worker_pool.hpp"
#include "sand/replica.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/sand/sand_of.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

using sand::Edit;
using sand::kProbePerCell;
using sand::Replica;
using sand::Step;

sand::ProbePoint cellAt(int column, int row, int height /* [cell] */) {
    return {column * kProbePerCell, row * kProbePerCell, height * kProbePerCell};
}

/// Numbers the steps of one replica and applies them.
class Hand {
public:
    explicit Hand(Replica& replica) : replica_(replica) {}

    void hover(const Edit& edit = Edit::none) { replica_.apply({1, replica_.stepNumber() + 1, false, {}, edit}); }
    void lift() { replica_.apply({1, replica_.stepNumber() + 1, false, {cellAt(32, 32, 30)}, Edit::none}); }
    void dig(int column, int row, const Edit& edit = Edit::none) {
        replica_.apply({1, replica_.stepNumber() + 1, true, {cellAt(column, row, 0)}, edit});
    }
    void stroke(int row) {
        for (int column = 16; column < 48; ++column) {
            dig(column, row);
        }
        lift();
    }

private:
    Replica& replica_;
};

/// Sand that slides under an open rim: heights, outflow and inertia can all go wrong.
scene::Scene slidingScene() {
    scene::Scene scene = samples::flatScene(64, 64);
    scene.terrain = samples::cylinder(64, 24, 40);
    scene.rules.rim = sand::Rim::open;
    return scene;
}

// What an edit does is tested by name. This test finds an edit that the replica does not know.
TEST(Edit, OfEachKindChangesTheSandOrItsTuning) {
    const scene::Scene scene = slidingScene();
    Replica replica(scene);
    Hand(replica).stroke(32);
    Replica untouched(replica);
    Hand(untouched).hover();
    for (const auto& known : valuesOf(Edit::Kind{})) {
        Edit edit = known.value;
        if (edit.kind == Edit::tune) {
            sand::Tuning tuning = scene.rules.tuning;
            tuning.threshold /= 2;
            edit = Edit::tuned(tuning);
        } else if (edit.kind == Edit::load) {
            edit = Edit::loaded(Replica(samples::flatScene(64, 64)).copySand()->encode());
        }
        Replica edited(replica);
        Hand(edited).hover(edit);
        EXPECT_TRUE(edited.leftOut().empty()) << edited.leftOut();
        EXPECT_NE(edited.stateHash(), untouched.stateHash()) << known.name;
    }
}

TEST(Undo, RestoresTheHeightsOfBeforeTheLastStroke) {
    const scene::Scene scene = samples::flatScene(64, 64);
    Replica replica(scene);
    Hand hand(replica);
    hand.stroke(20);
    const sand::HeightField first = samples::fieldOf(replica);
    hand.stroke(40);
    ASSERT_FALSE(sameHeights(samples::fieldOf(replica), first))
        << "the second stroke must move sand, or the test proves nothing";
    hand.hover(Edit::undo);
    EXPECT_TRUE(sameHeights(samples::fieldOf(replica), first));
    EXPECT_FALSE(sameHeights(samples::fieldOf(replica), scene.terrain)) << "only the last stroke";
}

// The whole state is restored, except step number and tool. Equal steps therefore have equal results afterwards.
TEST(Undo, GoesOnAsIfTheStrokeHadNotBeen) {
    Replica replica(slidingScene());
    Hand hand(replica);
    for (int i = 0; i < 5; ++i) {
        hand.hover();
    }
    Replica other(replica);
    hand.stroke(32);
    hand.hover(Edit::undo);
    ASSERT_FALSE(replica.settled());
    EXPECT_TRUE(sameHeights(samples::fieldOf(replica), samples::fieldOf(other)));
    EXPECT_EQ(replica.outflow(), other.outflow());
    Hand untouched(other);
    for (int i = 0; i < 30; ++i) {
        hand.hover();
        untouched.hover();
        ASSERT_TRUE(sameHeights(samples::fieldOf(replica), samples::fieldOf(other))) << i << " steps later";
        ASSERT_EQ(replica.outflow(), other.outflow());
    }
    EXPECT_GT(other.outflow(), 0) << "no sand fell over the rim, so that this test proves nothing";
}

// The tool is back at its place, so that only the step number differs. The test writes that number into the earlier
// state.
TEST(Undo, RestoresTheHashOfBeforeTheStroke) {
    Replica undone(slidingScene());
    Hand hand(undone);
    hand.lift();
    Replica idle(undone);
    hand.dig(32, 32);
    hand.lift();
    hand.hover(Edit::undo);
    base::Bytes state = idle.encodeState();
    state[4] = static_cast<std::uint8_t>(undone.stepNumber());  // eight bytes after the version
    Replica expected(slidingScene());
    expected.decodeState(state);
    EXPECT_EQ(undone.stateHash(), expected.stateHash());
}

TEST(Undo, OfAnUndoDoesNothingMore) {
    Replica replica(samples::flatScene(64, 64));
    Hand hand(replica);
    EXPECT_FALSE(replica.canUndo());
    hand.hover(Edit::undo);
    hand.stroke(20);
    hand.stroke(40);
    EXPECT_TRUE(replica.canUndo());
    hand.hover(Edit::undo);
    EXPECT_FALSE(replica.canUndo());
    Replica other(replica);
    hand.hover(Edit::undo);
    Hand(other).hover();
    EXPECT_EQ(replica.stateHash(), other.stateHash()) << "this edit must act as an ordinary step";
}

TEST(Undo, TakesBackWhatSettledSince) {
    Replica replica(slidingScene());
    Hand hand(replica);
    hand.hover();
    const sand::HeightField before = samples::fieldOf(replica);
    hand.dig(32, 32);
    hand.lift();
    hand.hover(Edit::settle);
    ASSERT_TRUE(replica.settled());
    hand.hover(Edit::undo);
    EXPECT_TRUE(sameHeights(samples::fieldOf(replica), before));
}

// The operator acts during the stroke. The stroke then begins where the undo left the sand.
TEST(Undo, InMidStrokeLetsTheStrokeBeginAnew) {
    const scene::Scene scene = samples::flatScene(64, 64);
    Replica replica(scene);
    Hand hand(replica);
    hand.dig(20, 32);
    hand.dig(24, 32, Edit::undo);
    Replica pressed(scene);
    Hand(pressed).dig(24, 32, Edit::reset);
    EXPECT_TRUE(sameHeights(samples::fieldOf(replica), samples::fieldOf(pressed))) << "the tool presses once";
    ASSERT_FALSE(sameHeights(samples::fieldOf(replica), scene.terrain));
    hand.dig(28, 32);
    hand.lift();
    ASSERT_FALSE(sameHeights(samples::fieldOf(replica), scene.terrain));
    hand.hover(Edit::undo);
    EXPECT_TRUE(sameHeights(samples::fieldOf(replica), scene.terrain));
}

TEST(Reset, RestoresTheSceneAndForgetsTheStroke) {
    const scene::Scene scene = slidingScene();
    Replica replica(scene);
    Hand hand(replica);
    hand.stroke(20);
    ASSERT_NE(replica.outflow(), 0);
    hand.hover(Edit::reset);
    EXPECT_TRUE(sameHeights(samples::fieldOf(replica), scene.terrain));
    EXPECT_EQ(replica.outflow(), 0);
    EXPECT_FALSE(replica.canUndo());
    Replica fresh(scene);
    Hand untouched(fresh);
    for (int i = 0; i < 30; ++i) {
        hand.hover();
        untouched.hover();
        ASSERT_TRUE(sameHeights(samples::fieldOf(replica), samples::fieldOf(fresh))) << i << " steps later";
    }
}

TEST(Load, PutsBackHeightsOutflowAndInertiaAndForgetsTheStroke) {
    Replica replica(slidingScene());
    Hand hand(replica);
    for (int i = 0; i < 5; ++i) {
        hand.hover();
    }
    ASSERT_FALSE(replica.settled()) << "sand at rest has no inertia to lose";
    Replica other(replica);
    const Edit load = Edit::loaded(replica.copySand()->encode());
    hand.stroke(32);
    hand.hover(load);
    EXPECT_TRUE(sameHeights(samples::fieldOf(replica), samples::fieldOf(other)));
    EXPECT_FALSE(replica.canUndo());
    Hand untouched(other);
    for (int i = 0; i < 30; ++i) {
        hand.hover();
        untouched.hover();
        ASSERT_TRUE(sameHeights(samples::fieldOf(replica), samples::fieldOf(other))) << i << " steps later";
        ASSERT_EQ(replica.outflow(), other.outflow());
    }
}

TEST(Load, OfBytesThatAreNoSandOfThisFieldIsAStepLikeAnyOther) {
    const base::Bytes whole = Replica(slidingScene()).copySand()->encode();
    base::Bytes longer = whole;
    longer.push_back(0);
    const base::Bytes larger = Replica(samples::flatScene(65, 64)).copySand()->encode();
    for (const base::Bytes& bytes : {base::Bytes(), base::Bytes(whole.begin(), whole.end() - 1), longer, larger}) {
        Replica replica(slidingScene());
        Replica other(replica);
        Hand(replica).hover(Edit::loaded(bytes));
        Hand(other).hover();
        EXPECT_EQ(replica.stateHash(), other.stateHash());
    }
}

TEST(Undo, KeepsWhatTheOperatorHasChosen) {
    const scene::Scene scene = samples::flatScene(64, 64);
    Replica replica(scene);
    Hand hand(replica);
    hand.stroke(20);
    sand::Tuning tuning = scene.rules.tuning;
    tuning.tool.radius *= 2;
    hand.hover(Edit::tuned(tuning));
    hand.hover(Edit::undo);
    EXPECT_EQ(replica.rules().tuning, tuning);
    hand.hover(Edit::reset);
    EXPECT_EQ(replica.rules().tuning, tuning);
    EXPECT_TRUE(sameHeights(samples::fieldOf(replica), scene.terrain));
}

/// Random strokes with occasional edits of every kind.
Step editedStep(std::uint64_t number, const sand::Rules& rules, std::mt19937& random) {
    Step step = samples::randomStep(number, rules, random);
    const auto draw = random() % 40;
    step.edit = draw < 5 ? Edit::undo : draw == 5 ? Edit::reset : draw == 6 ? Edit::settle : Edit::none;
    if (draw == 7 || draw == 8) {
        sand::Tuning tuning = rules.tuning;
        tuning.threshold = tuning.threshold / 2 + static_cast<std::int32_t>(random() % 60000);
        tuning.startThreshold = tuning.threshold + 100;
        tuning.tool.radius += static_cast<std::int32_t>(random() % 512);
        step.edit = Edit::tuned(tuning);
    }
    return step;
}

TEST(Edits, VolumeIsExactAndTheHashIsTheWholeFields) {
    for (const auto rim : {sand::Rim::closed, sand::Rim::open}) {
        scene::Scene scene = samples::flatScene(45, 33, 2.56);
        scene.rules.rim = rim;
        std::mt19937 random(53);
        scene.terrain = samples::randomField(45, 33, 1 << 18, random);
        Replica replica(scene);
        for (std::uint64_t i = 1; i <= 200; ++i) {
            const sand::HeightField before = samples::fieldOf(replica);
            (void)replica.takeChange();
            replica.apply(editedStep(i, scene.rules, random));
            ASSERT_EQ(samples::fieldOf(replica).volume() + replica.outflow(), scene.terrain.volume()) << "step " << i;
            const std::vector<sand::CellRect> changed = samples::takeCells(replica);
            for (int y = 0; y < 33; ++y) {
                for (int x = 0; x < 45; ++x) {
                    const bool listed = std::ranges::any_of(changed, [x, y](const sand::CellRect& cells) {
                        return x >= cells.x0 && x < cells.x1 && y >= cells.y0 && y < cells.y1;
                    });
                    ASSERT_TRUE(listed || before.height(x, y) == samples::fieldOf(replica).height(x, y))
                        << x << ", " << y;
                }
            }
            const std::uint64_t incremental = replica.stateHash();
            replica.audit(replica.hashTiles().tileCount());
            ASSERT_EQ(replica.stateHash(), incremental) << "step " << i;
        }
    }
}

TEST(Edits, ThreadsAndBlocksChangeNothingAndAStateTakesTheStrokeAlong) {
    const scene::Scene scene = slidingScene();
    const host::WorkerPool pool(3);
    sand::grid::Erosion::Options threaded;
    threaded.executor = pool.lend();
    threaded.blockSize = 8;
    Replica plain(scene);
    Replica blocks = samples::replicaSwept(scene, threaded);
    Replica joined(scene);
    std::mt19937 random(59);
    for (std::uint64_t i = 1; i <= 150; ++i) {
        const Step step = editedStep(i, scene.rules, random);
        for (Replica* replica : {&plain, &blocks, &joined}) {
            replica->apply(step);
        }
        if (i % 7 == 0) {
            Replica fresh(scene);
            fresh.decodeState(joined.encodeState());
            joined = fresh;
        }
        ASSERT_EQ(blocks.stateHash(), plain.stateHash()) << "step " << i << " of seed 59";
        ASSERT_EQ(joined.stateHash(), plain.stateHash()) << "step " << i << " of seed 59";
        ASSERT_EQ(joined.canUndo(), plain.canUndo());
    }
}

TEST(Edits, AStateWithASpoiltStrokeIsRefusedWhole) {
    const scene::Scene scene = samples::flatScene(64, 64);
    Replica dug(scene);
    Hand(dug).stroke(32);
    base::Bytes state = dug.encodeState();
    base::ByteReader reader(state);
    (void)base::read<sand::StateHead>(reader);
    (void)reader.getBlock();  // movement
    constexpr std::size_t kBefore =
        4 + 8 + 4;  // length of the sand before the stroke, its outflow, length of its heights
    state[state.size() - reader.rest().size() + kBefore] ^= 0xff;  // the first byte of the compressed heights
    Replica replica(scene);
    const std::uint64_t hash = replica.stateHash();
    EXPECT_THROW(replica.decodeState(state), base::FormatError);
    EXPECT_EQ(replica.stateHash(), hash);
    EXPECT_FALSE(replica.canUndo());
}

}  // namespace
