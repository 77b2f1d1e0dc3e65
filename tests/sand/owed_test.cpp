// SPDX-License-Identifier: Apache-2.0
#include "sand/model/owed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "host/worker_pool.hpp"
#include "tests/sand/spread/sessions.hpp"
#include "tests/support/borders/border_scenes.hpp"
#include "tests/support/seed.hpp"

namespace {

using sand::Edit;
using sand::Heading;
using sand::Owed;
using sand::Replica;
using sand::Step;

constexpr int kWhole = 40;  // sweeps of a step

/// Returns level sand with a block of 10 x 10 cells. If it is 40 cells high, it slides for longer than a step.
scene::Scene towerScene(int cellsHigh = 40) {
    scene::Scene scene = samples::flatScene(64, 48, 5);
    for (int y = 19; y < 29; ++y) {
        for (int x = 27; x < 37; ++x) {
            scene.terrain.setHeight(x, y, cellsHigh * sand::kUnitsPerCell);
        }
    }
    scene.rules.tuning.sweepsPerStep = kWhole;
    return scene;
}

Step next(const Replica& sand, std::int32_t sweeps, Step step = {}) {
    step.epoch = 1;
    step.number = sand.stepNumber() + 1;
    step.sweeps = sweeps;
    return step;
}

/// Returns the tower with a tool in the sand beside it, and 30 sweeps owed.
Replica owing() {
    Replica sand(towerScene());
    sand.apply(next(sand, 10, {.engaged = true, .path = {borders::probeAt(20, 24, 2)}}));
    EXPECT_EQ(sand.owed(), (Owed{kWhole, 10}));
    return sand;
}

/// Returns all state of `sand` except the number of its step.
base::Bytes stateOf(const Replica& sand) {
    const base::Bytes state = sand.encodeState();
    base::ByteReader reader(state);
    auto head = base::read<sand::StateHead>(reader);
    head.number = 0;
    base::Bytes bytes = base::encoded(head);
    bytes.insert(bytes.end(), reader.rest().begin(), reader.rest().end());
    return bytes;
}

TEST(Owed, PartsOfAStepLeaveTheSandOfTheWholeStep) {
    host::WorkerPool team(2);
    const unsigned seed = test::randomSeed();
    for (unsigned i = 0; i < 10; ++i) {
        EXPECT_EQ(spread::firstDifference(seed + i, 12, samples::kSanitized ? nullptr : team.lend()), "");
    }
}

TEST(Owed, AStepOwesTheSweepsOfTheSceneWhetherItHoversOrNot) {
    for (const bool engaged : {false, true}) {
        Replica sand(towerScene());
        EXPECT_EQ(sand.mostSweeps({.engaged = engaged}), kWhole);
        EXPECT_FALSE(sand.holdsTool());
        for (const int left : {33, 26, 19, 12, 5}) {
            sand.apply(next(sand, 7, {.engaged = engaged}));
            EXPECT_EQ(sand.owed().left(), left);
            EXPECT_TRUE(sand.holdsTool());
        }
        EXPECT_EQ(sand.mostSweeps({.engaged = engaged}), sand.owed().left());
        sand.apply(next(sand, 0, {.engaged = engaged}));
        EXPECT_EQ(sand.owed(), Owed());
    }
}

TEST(Owed, ASweepThatMovesNoSandEndsWhatIsOwed) {
    scene::Scene scene = towerScene(3);
    scene.rules.tuning.sweepsPerStep = sand::kMostSweeps;
    Replica sand(scene), joined(scene);
    int parts = 0;
    do {
        joined.decodeState(sand.encodeState());  // which visits all blocks again
        sand.apply(next(sand, 1));
        joined.apply(next(joined, 1));
        EXPECT_EQ(sand.stateHash(), joined.stateHash());
        ++parts;
    } while (sand.owed().any() && parts < sand::kMostSweeps);
    EXPECT_GT(parts, 3);
    EXPECT_LT(parts, 1000);
    EXPECT_TRUE(sand.settled());
}

TEST(AtRest, ASandWhoseNextStepChangesItsNumberAlone) {
    Replica sand(towerScene(3));
    EXPECT_FALSE(sand.atRest()) << "no sweep has looked";
    const auto bring = [&sand](const Step& step) {
        int steps = 0;
        for (bool moves = true; moves && steps < 4000; ++steps) {
            sand.apply(next(sand, std::min(5, sand.mostSweeps(step)), step));
            moves = !sand.atRest();
            EXPECT_FALSE(!moves && sand.owed().any());
        }
        EXPECT_TRUE(sand.atRest());
        return steps;
    };
    for (const bool engaged : {false, true}) {
        if (engaged) {
            sand.apply(next(sand, 0, {.engaged = true, .path = {borders::probeAt(20, 24, 2)}}));
            EXPECT_FALSE(sand.atRest()) << "it has pressed";
        }
        EXPECT_GE(bring({.engaged = engaged}), engaged ? 1 : 3);
        const auto before = stateOf(sand);
        for (int i = 0; i < 100; ++i) {
            sand.apply(next(sand, 1, {.engaged = engaged}));
            ASSERT_TRUE(sand.atRest());
        }
        EXPECT_EQ(stateOf(sand), before);
    }
    sand.apply(next(sand, 1, {.edit = Edit::tuned(sand.rules().tuning)}));
    EXPECT_FALSE(sand.atRest()) << "all sand is looked at again";
    Replica joined(towerScene(3));
    joined.decodeState(sand.encodeState());
    EXPECT_FALSE(joined.atRest());
}

TEST(Owed, AMovementOfTheToolIsLeftOutUntilAllIsPaid) {
    const Replica before = owing();
    const sand::ProbePoint here = before.probe();
    const std::vector<Step> movements{{.engaged = true, .path = {borders::probeAt(21, 24, 2)}},
                                      {.engaged = true, .path = {here}},  // would press once more
                                      {.engaged = true, .path = {}, .heading = Heading{0, 16384, false}},
                                      {.engaged = false},
                                      {.engaged = false, .path = {}, .edit = Edit::reset}};
    for (const Step& movement : movements) {
        Replica sand = before;
        sand.apply(next(sand, 1, movement));
        EXPECT_TRUE(sand.refusedStep());
        EXPECT_EQ(sand.leftOut(), "it moves the tool while 30 sweeps are owed");
        EXPECT_EQ(sand.stepNumber(), before.stepNumber() + 1);
        EXPECT_EQ(stateOf(sand), stateOf(before));
        sand.apply(next(sand, 30, {.engaged = true}));
        EXPECT_FALSE(sand.refusedStep());
        sand.apply(next(sand, 1, movement));
        EXPECT_EQ(sand.leftOut(), "") << "all was paid";
    }
    Replica sand = before;
    sand.apply(next(sand, 1, {.engaged = true, .path = {}, .heading = before.heading()}));
    EXPECT_FALSE(sand.refusedStep()) << "this heading turns nothing";
}

TEST(Owed, AToolThatHoversMayMoveButNotEngage) {
    Replica sand(towerScene());
    sand.apply(next(sand, 10));
    sand.apply(next(sand, 1, {.engaged = false, .path = {borders::probeAt(20, 24, 2)}}));
    EXPECT_FALSE(sand.refusedStep());
    EXPECT_EQ(sand.owed(), (Owed{kWhole, 11}));
    sand.apply(next(sand, 1, {.engaged = true, .path = {borders::probeAt(20, 24, 2)}}));
    EXPECT_TRUE(sand.refusedStep());
}

TEST(Owed, AStepThatPaysTooMuchIsLeftOut) {
    const Replica before = owing();
    Replica sand = before;
    sand.apply(next(sand, 31, {.engaged = true}));
    EXPECT_TRUE(sand.refusedStep());
    EXPECT_EQ(sand.leftOut(), "it runs 31 sweeps, and 30 are owed");
    EXPECT_EQ(stateOf(sand), stateOf(before));
    Replica fresh(towerScene());
    fresh.apply(next(fresh, kWhole + 1));
    EXPECT_TRUE(fresh.refusedStep());
}

TEST(Owed, RestoredSandOwesNothing) {
    const std::vector<Edit> edits{Edit::undo, Edit::reset, Edit::loaded(Replica(towerScene()).copySand()->encode())};
    for (const Edit& edit : edits) {
        Replica sand = owing();
        sand.apply(next(sand, 1, {.engaged = true, .path = {}, .edit = edit}));
        EXPECT_EQ(sand.leftOut(), "");
        EXPECT_EQ(sand.owed(), Owed());
        EXPECT_EQ(samples::erosionOf(sand).sweepsDone(), 10) << "it runs none";
    }
}

TEST(Owed, AnEditWithoutEffectOnlyPays) {
    Replica sand(towerScene());
    sand.apply(next(sand, 10));
    for (const Edit& edit : {Edit(Edit::undo), Edit::loaded({1, 2, 3})}) {
        const int left = sand.owed().left();
        sand.apply(next(sand, 10, {.engaged = false, .path = {}, .edit = edit}));
        EXPECT_FALSE(sand.refusedStep());
        EXPECT_EQ(sand.owed().left(), left - 10);
    }
}

TEST(Owed, ATuneOwesItsOwnSweeps) {
    Replica sand = owing();
    sand::Tuning tuning = sand.rules().tuning;
    tuning.sweepsPerStep = 100;
    const Step tune{.engaged = true, .path = {}, .edit = Edit::tuned(tuning)};
    EXPECT_EQ(sand.mostSweeps(tune), 100);
    sand.apply(next(sand, 60, tune));
    EXPECT_EQ(sand.owed(), (Owed{100, 60}));
}

/// Returns the tower while it settles around a tool that is held.
Replica settling() {
    Replica sand = owing();
    sand.apply(next(sand, 10, {.engaged = true, .path = {}, .edit = Edit::settle}));
    EXPECT_EQ(sand.owed(), (Owed{Owed::kUntilRest, 10}));
    EXPECT_TRUE(sand.settling());
    EXPECT_FALSE(sand.holdsTool());
    return sand;
}

TEST(Owed, TheFirstMovementOfTheToolEndsASettle) {
    for (const Step& movement : {Step{.engaged = true, .path = {borders::probeAt(21, 24, 2)}}, Step{.engaged = false},
                                 Step{.engaged = true, .path = {}, .heading = Heading{0, 16384, false}}}) {
        Replica sand = settling();
        EXPECT_EQ(sand.mostSweeps(movement), kWhole);
        sand.apply(next(sand, 5, movement));
        EXPECT_EQ(sand.leftOut(), "");
        EXPECT_EQ(sand.owed(), (Owed{kWhole, 5}));
    }
    Replica sand = settling();
    EXPECT_EQ(sand.mostSweeps({.engaged = true}), sand::kMostSweeps);
    for (int i = 0; i < 1000 && sand.settling(); ++i) {
        sand.apply(next(sand, 100, {.engaged = true}));
    }
    EXPECT_EQ(sand.owed(), Owed());
    EXPECT_TRUE(sand.settled());
}

TEST(Owed, StepsOfATinStateNoSweeps) {
    borders::Case given;
    given.tin = true;
    given.height = [](double x, double) { return x < 20 ? 40.0 : 8.0; };
    Replica sand(borders::sceneOf(given));
    EXPECT_EQ(sand.mostSweeps({}), 0);
    sand.apply(next(sand, 0, {.engaged = true, .path = {borders::probeAt(30, 24, 9)}}));
    EXPECT_EQ(sand.owed(), Owed());
    EXPECT_EQ(sand.mostSweeps({.engaged = true, .path = {}, .edit = Edit::settle}), 0);
    Step step{.number = 3};
    const sand::StepLimits ofTin = sand.rules().stepLimits(), ofGrid = towerScene().rules.stepLimits();
    EXPECT_EQ(step.refusal(ofTin), "");
    EXPECT_EQ(step.refusal(ofGrid), "step 3 states 0 sweeps; a step of this sand states 1 to 4096");
    step.sweeps = 2;
    EXPECT_EQ(step.refusal(ofTin), "step 3 states 2 sweeps; a step of this sand states none");
    EXPECT_EQ(step.refusal(ofGrid), "");
}

TEST(Owed, AReplicaThatLoadsAStatePaysWhatIsOwed) {
    Replica sand = owing();
    Replica joined(towerScene());
    joined.decodeState(sand.encodeState());
    ASSERT_EQ(joined.owed(), (Owed{kWhole, 10}));
    for (int part = 0; part < 3; ++part) {
        sand.apply(next(sand, 10, {.engaged = true}));
        joined.apply(next(joined, 10, {.engaged = true}));
        EXPECT_EQ(joined.stateHash(), sand.stateHash());
    }
    EXPECT_EQ(joined.owed(), Owed());
}

TEST(Owed, AnImpossibleStateIsRefused) {
    Replica sand = owing();
    const base::Bytes state = sand.encodeState();
    for (const Owed& wrong :
         {Owed{40, 40}, Owed{0, 1}, Owed{sand::kMostSweeps + 1, 0}, Owed{Owed::kUntilRest + 1, 0}}) {
        base::ByteReader reader(state);
        auto head = base::read<sand::StateHead>(reader);
        head.owed = wrong;
        base::Bytes bytes = base::encoded(head);
        bytes.insert(bytes.end(), reader.rest().begin(), reader.rest().end());
        EXPECT_THROW(sand.decodeState(bytes), base::FormatError) << wrong.whole << ", " << wrong.done;
    }
    EXPECT_EQ(sand.encodeState(), state);
}

}  // namespace
