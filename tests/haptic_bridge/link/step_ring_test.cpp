// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/link/step_ring.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace {

using haptic_bridge::NeedState;
using haptic_bridge::StepRing;

std::uint64_t hashAfter(std::uint64_t step) { return 1000 + step; }

/// Adds the steps `first` to `last` to the ring of a wall, with the hash after each.
void apply(StepRing& ring, std::uint64_t first, std::uint64_t last) {
    for (std::uint64_t number = first; number <= last; ++number) {
        ring.add({1, number, false, {}});
        ring.reached(number, hashAfter(number));
    }
}

StepRing ringUntil(std::uint64_t last) {
    StepRing ring;
    ring.reached(0, hashAfter(0));
    apply(ring, 1, last);
    return ring;
}

/// Returns the numbers of the steps from there on; empty if they are not known.
std::vector<std::uint64_t> numbers(const StepRing& ring, std::uint64_t step, std::uint64_t hash, std::uint64_t until) {
    std::vector<std::uint64_t> found;
    for (const sand::Step& one : ring.since(NeedState{step, hash}, until).value_or(std::vector<sand::Step>())) {
        found.push_back(one.number);
    }
    return found;
}

TEST(StepRing, GivesTheStepsBehindAHashThatWasReached) {
    const StepRing ring = ringUntil(6);
    EXPECT_EQ(numbers(ring, 2, hashAfter(2), 5), (std::vector<std::uint64_t>{3, 4, 5}));
    EXPECT_EQ(numbers(ring, 0, hashAfter(0), 2), (std::vector<std::uint64_t>{1, 2}));
    EXPECT_EQ(numbers(ring, 5, hashAfter(5), 6), (std::vector<std::uint64_t>{6}));
}

TEST(StepRing, GivesNoneBehindAnotherHashOrOneThatNobodyKnows) {
    StepRing ring = ringUntil(6);
    EXPECT_FALSE(ring.since({2, hashAfter(3)}, 5));
    EXPECT_FALSE(ring.since({0, hashAfter(1)}, 5));
    ring.add({1, 7, false, {}});  // applied, but its hash is not known yet
    ring.add({1, 8, false, {}});
    EXPECT_FALSE(ring.since({7, hashAfter(7)}, 8));
    EXPECT_FALSE(ring.since({7, 0}, 8));
}

TEST(StepRing, GivesNoneThatItDoesNotHold) {
    const StepRing ring = ringUntil(6);
    EXPECT_FALSE(ring.since({6, hashAfter(6)}, 7)) << "step 7 is unknown";
    EXPECT_FALSE(ring.since({6, hashAfter(6)}, 6)) << "no step is lacking";
    EXPECT_FALSE(ring.since({5, hashAfter(5)}, 4)) << "the server is ahead";
}

TEST(StepRing, HoldsTheLast240Steps) {
    const StepRing ring = ringUntil(StepRing::kSteps + 10);
    EXPECT_EQ(numbers(ring, 10, hashAfter(10), StepRing::kSteps + 10).size(), StepRing::kSteps);
    EXPECT_FALSE(ring.since({9, hashAfter(9)}, StepRing::kSteps + 10));
}

// Loaded sand is too large for a catch-up.
TEST(StepRing, BeginsAnewBehindALoad) {
    StepRing ring = ringUntil(6);
    ring.add({1, 7, false, {}, sand::Edit::loaded(base::Bytes(10, 1))});
    ring.reached(7, hashAfter(7));
    apply(ring, 8, 9);
    EXPECT_FALSE(ring.since({6, hashAfter(6)}, 9));
    EXPECT_EQ(numbers(ring, 7, hashAfter(7), 9), (std::vector<std::uint64_t>{8, 9}));
}

TEST(StepRing, BeginsAnewBehindAGap) {
    StepRing ring = ringUntil(6);
    apply(ring, 9, 11);
    EXPECT_FALSE(ring.since({6, hashAfter(6)}, 11));
    EXPECT_EQ(numbers(ring, 9, hashAfter(9), 11), (std::vector<std::uint64_t>{10, 11}));
    ring.reached(3, 7);  // the sand of a checkpoint
    EXPECT_FALSE(ring.since({9, hashAfter(9)}, 11));
    apply(ring, 4, 5);
    EXPECT_EQ(numbers(ring, 3, 7, 5), (std::vector<std::uint64_t>{4, 5}));
}

}  // namespace
