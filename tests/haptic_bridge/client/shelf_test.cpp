// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/client/shelf.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "haptic_bridge/client/grant.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

using namespace haptic_bridge;

TimedStep timed(std::uint64_t number) {
    TimedStep step;
    step.step.number = number;
    return step;
}

std::vector<std::uint64_t> numbersOf(const std::vector<TimedStep>& steps) {
    std::vector<std::uint64_t> numbers(steps.size());
    std::ranges::transform(steps, numbers.begin(), [](const TimedStep& step) { return step.step.number; });
    return numbers;
}

TEST(Shelf, HandsStepsOverInOrderAndAtMostAsManyAsWanted) {
    Shelf shelf;
    for (std::uint64_t number = 1; number <= 5; ++number) {
        EXPECT_FALSE(shelf.add(timed(number)));
    }
    bool resume = true;
    EXPECT_EQ(numbersOf(shelf.drain(3, resume)), (std::vector<std::uint64_t>{1, 2, 3}));
    EXPECT_FALSE(resume) << "the shelf was never full";
    EXPECT_EQ(numbersOf(shelf.drain(9, resume)), (std::vector<std::uint64_t>{4, 5}));
    EXPECT_EQ(shelf.counters().stepsIn, 5U);
}

TEST(Shelf, AFullShelfHoldsTheServerBackUntilSomebodyDrains) {
    Shelf shelf;
    for (std::uint64_t number = 1; number < Client::kMaxQueued; ++number) {
        ASSERT_FALSE(shelf.add(timed(number)));
    }
    EXPECT_TRUE(shelf.add(timed(Client::kMaxQueued)));
    EXPECT_TRUE(shelf.full());
    bool resume = true;
    (void)shelf.drain(0, resume);
    EXPECT_FALSE(resume) << "no step was drained";
    (void)shelf.drain(1, resume);
    EXPECT_TRUE(resume);
    EXPECT_FALSE(shelf.full());
}

// A test that comes while a frame is drawn belongs to the next frame, as a step does.
TEST(Shelf, ATestIsInTheFrameThatTakesTheStepsBeforeIt) {
    Shelf shelf;
    (void)shelf.add(timed(1));
    shelf.addTest(10, 1);
    (void)shelf.add(timed(2));
    shelf.addTest(20, 2);
    EXPECT_TRUE(shelf.takeTestsInFrame().empty());
    bool resume = false;
    (void)shelf.drain(1, resume);
    EXPECT_EQ(shelf.takeTestsInFrame(), std::vector<std::uint32_t>{10});
    (void)shelf.drain(1, resume);
    EXPECT_EQ(shelf.takeTestsInFrame(), std::vector<std::uint32_t>{20});
    EXPECT_TRUE(shelf.takeTestsInFrame().empty()) << "each test is returned once";
}

TEST(Shelf, AnOfferIsTakenOnceAndDropsStepsOfTheLinkBefore) {
    Shelf shelf;
    shelf.setStatus(Link::connecting, "a");
    EXPECT_FALSE(shelf.beginGranting());
    shelf.setStatus(Link::offered, "b");
    (void)shelf.add(timed(1));
    EXPECT_TRUE(shelf.beginGranting());
    EXPECT_EQ(shelf.link(), Link::granting);
    EXPECT_FALSE(shelf.beginGranting()) << "a caller that polls again sees no offer";
    bool resume = false;
    EXPECT_TRUE(shelf.drain(9, resume).empty());
}

TEST(Shelf, AStatusThatSaysTheSameIsNoChange) {
    Shelf shelf;
    shelf.setStatus(Link::connecting, "nobody");
    const std::uint64_t changes = shelf.status().changes;
    shelf.setStatus(Link::connecting, "nobody");
    EXPECT_EQ(shelf.status().changes, changes);
    shelf.setStatus(Link::connecting, "somebody");
    EXPECT_EQ(shelf.status().changes, changes + 1);
}

TEST(Shelf, CountsAFloodOfPositionsOnceUntilTheyAreTaken) {
    Shelf shelf;
    for (std::size_t i = 1; i < Client::kMaxPositions; ++i) {
        ASSERT_FALSE(shelf.add(TimedPosition{}));
    }
    EXPECT_TRUE(shelf.add(TimedPosition{}));
    EXPECT_FALSE(shelf.add(TimedPosition{})) << "a position that was already on its way";
    EXPECT_EQ(shelf.floods(), 1U);
    bool resume = false;
    EXPECT_EQ(shelf.drainPositions(resume).size(), Client::kMaxPositions + 1);
    EXPECT_TRUE(resume);
}

TEST(Shelf, HoldsSoManyBytesOfTicks) {
    Shelf shelf;
    for (int i = 0; i < 5000; ++i) {
        shelf.addTicks(base::Bytes(60'000, 1));
    }
    std::size_t bytes = 0;
    for (const base::Bytes& piece : shelf.drainTicks()) {
        bytes += piece.size();
    }
    EXPECT_LE(bytes, Client::kMaxTicks);
    EXPECT_GT(bytes, Client::kMaxTicks / 2);
    shelf.addTicks({1});
    EXPECT_EQ(shelf.drainTicks().size(), 1U) << "there is room again";
    for (std::size_t i = 0; i < Client::kMaxTicks; i += 32) {
        shelf.addTicks({});
    }
    EXPECT_LE(shelf.drainTicks().size(), Client::kMaxTicks / 64) << "an empty piece takes memory, too";
}

sand::Step numbered(std::uint64_t number, std::uint32_t epoch = 1) {
    sand::Step step;
    step.epoch = epoch;
    step.number = number;
    return step;
}

Grant::Arrival arrival(Grant& grant, sand::Step step) { return grant.arrived(step); }

TEST(Grant, JudgesStepsByEpochAndNumber) {
    Grant grant({3, 10, 0}, {});
    EXPECT_EQ(arrival(grant, numbered(11, 2)), Grant::Arrival::foreign);
    EXPECT_EQ(arrival(grant, numbered(10, 3)), Grant::Arrival::stale);
    EXPECT_EQ(arrival(grant, numbered(12, 3)), Grant::Arrival::afterGap);
    EXPECT_EQ(arrival(grant, numbered(11, 3)), Grant::Arrival::next);
    EXPECT_EQ(arrival(grant, numbered(11, 3)), Grant::Arrival::stale) << "a step that came twice";
    EXPECT_EQ(grant.lastStep(), 11U);
    EXPECT_EQ(grant.bounded({9, 1}).stepNumber, 10U) << "a frame drawn before the grant";
    EXPECT_EQ(grant.bounded({10, 1, haptic_bridge::Held::disk}),
              (haptic_bridge::Shown{10, 1, haptic_bridge::Held::disk}));
    EXPECT_EQ(grant.bounded({15, 1}).stepNumber, 11U) << "steps that the master has numbered since";
}

sand::Step withEdit(std::uint64_t number, const sand::Edit& edit) {
    sand::Step step = numbered(number);
    step.edit = edit;
    return step;
}

/// Returns how `grant` classifies step `number` with edit `edit`.
Grant::Arrival arrival(Grant& grant, std::uint64_t number, const sand::Edit& edit) {
    return arrival(grant, withEdit(number, edit));
}

using samples::withNumber;

// An edit goes into the journal, and may be 192 MiB of sand.
TEST(Grant, TakesAnEditOnceAndOnlyIfItWasAskedFor) {
    Grant grant({1, 0, 0}, {});
    const sand::Edit load = withNumber(5, sand::Edit::loaded({1, 2, 3}));
    EXPECT_EQ(arrival(grant, 1, load), Grant::Arrival::unasked);
    EXPECT_EQ(arrival(grant, 1, withNumber(1, sand::Edit::settle)), Grant::Arrival::unasked);
    EXPECT_EQ(grant.lastStep(), 0U);
    grant.asked(load);
    EXPECT_EQ(arrival(grant, 1, withNumber(6, load)), Grant::Arrival::unasked) << "a number that was not given";
    EXPECT_EQ(arrival(grant, 1, withNumber(0, load)), Grant::Arrival::unasked);
    EXPECT_EQ(arrival(grant, 1, withNumber(5, sand::Edit::settle)), Grant::Arrival::unasked) << "another kind";
    EXPECT_EQ(arrival(grant, 1, {}), Grant::Arrival::next) << "a step made before the request came";
    EXPECT_EQ(arrival(grant, 2, load), Grant::Arrival::next);
    EXPECT_EQ(arrival(grant, 3, load), Grant::Arrival::unasked) << "it was done already";
}

// So no server can change an edit, and 192 MiB are never compared.
TEST(Grant, GivesAStepTheEditThatWasAskedFor) {
    Grant grant({1, 0, 0}, {});
    const sand::Edit load = withNumber(7, sand::Edit::loaded({1, 2, 3}));
    const sand::Edit tune = withNumber(8, sand::Edit::tuned({7, 11, 13, {.radius = 17}}));
    grant.asked(load);
    grant.asked(tune);
    sand::Step loads = withEdit(1, withNumber(7, sand::Edit::loaded({6, 6, 6})));
    ASSERT_EQ(grant.arrived(loads), Grant::Arrival::next);
    EXPECT_EQ(loads.edit.sand, load.sand) << "the same bytes in memory";
    EXPECT_EQ(loads.edit.number, 7U);
    sand::Step tunes = withEdit(2, withNumber(8, sand::Edit::tuned({1, 1, 1, {.radius = 1}})));
    ASSERT_EQ(grant.arrived(tunes), Grant::Arrival::next);
    EXPECT_EQ(tunes.edit, tune);
}

TEST(Grant, TellsEqualEditsApart) {
    Grant grant({1, 0, 0}, {});
    for (const std::uint64_t number : {1U, 2U, 3U}) {
        grant.asked(withNumber(number, sand::Edit::loaded({1})));
    }
    EXPECT_EQ(arrival(grant, 1, withNumber(2, sand::Edit::loaded({1}))), Grant::Arrival::next);
    EXPECT_EQ(arrival(grant, 2, withNumber(1, sand::Edit::loaded({1}))), Grant::Arrival::unasked)
        << "the second has replaced it";
    EXPECT_EQ(arrival(grant, 2, withNumber(2, sand::Edit::loaded({1}))), Grant::Arrival::unasked);
    EXPECT_EQ(arrival(grant, 2, withNumber(3, sand::Edit::loaded({1}))), Grant::Arrival::next);
}

TEST(Grant, LetsAnEditReplaceTheOneBeforeIt) {
    Grant grant({1, 0, 0}, {});
    grant.asked(withNumber(1, sand::Edit::loaded({1})));
    grant.asked(withNumber(2, sand::Edit::settle));
    EXPECT_EQ(arrival(grant, 1, withNumber(2, sand::Edit::settle)), Grant::Arrival::next);
    EXPECT_EQ(arrival(grant, 2, withNumber(1, sand::Edit::loaded({1}))), Grant::Arrival::unasked);
}

TEST(Grant, HandsOverTheStepsThatAreLackedOnceAndThenTheSand) {
    StepRing ring;
    ring.reached(0, 77);
    for (std::uint64_t number = 1; number <= kMaxCatchUp + 3; ++number) {
        ring.add(numbered(number));
    }
    Grant grant({2, kMaxCatchUp + 3, 0}, ring);
    const auto steps = grant.catchUps({0, 77});
    ASSERT_EQ(steps.size(), 2U);
    EXPECT_FALSE(steps[0].last);
    EXPECT_EQ(steps[0].steps.size(), kMaxCatchUp);
    EXPECT_TRUE(steps[1].last);
    EXPECT_EQ(steps[1].steps.back().number, kMaxCatchUp + 3);
    EXPECT_FALSE(grant.awaitsState());
    ASSERT_TRUE(grant.mayHandOver());
    EXPECT_TRUE(grant.catchUps({0, 77}).empty()) << "the same steps would fail again";
    EXPECT_TRUE(grant.awaitsState());
    EXPECT_FALSE(grant.mayHandOver());
    grant.stateGiven();
    EXPECT_FALSE(grant.awaitsState());
}

TEST(Grant, HandsOverTheSandWhenTheStepsAreNotKnown) {
    Grant grant({2, 10, 0}, {});
    EXPECT_TRUE(grant.catchUps({3, 1}).empty());
    EXPECT_TRUE(grant.awaitsState());
    EXPECT_FALSE(grant.mayHandOver());
}

// The sand of an earlier grant must not go to the server of a later one.
TEST(Shelf, NeedsTheSandUntilItIsGivenOrTheLinkChanges) {
    Shelf shelf;
    shelf.askForState();
    EXPECT_FALSE(shelf.needsState()) << "the link is not granting";
    shelf.setStatus(Link::offered, "");
    ASSERT_TRUE(shelf.beginGranting());
    shelf.askForState();
    shelf.setStatus(Link::granting, "handing over");
    EXPECT_TRUE(shelf.needsState());
    EXPECT_TRUE(shelf.beginGivingState());
    EXPECT_FALSE(shelf.beginGivingState()) << "it is given once";
    shelf.askForState();
    shelf.setStatus(Link::lost, "");
    EXPECT_FALSE(shelf.beginGivingState());
}

}  // namespace
