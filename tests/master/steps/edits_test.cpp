// SPDX-License-Identifier: Apache-2.0
#include "master/steps/edits.hpp"

#include <gtest/gtest.h>

#include "base/input_error.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

using master::Edits;
using samples::withNumber;
using sand::Edit;

Edit loadOf(std::size_t bytes) { return Edit::loaded(base::Bytes(bytes)); }

/// Returns the step that has taken an edit out of those that wait.
master::ArrivedStep stepWith(const Edit& edit, Edits& edits) {
    master::ArrivedSteps steps(1);
    steps[0].step.edit = edit;
    edits.moveInto(steps);
    return steps[0];
}

TEST(Edits, GoIntoTheStepWithTheirNumberAndGiveItTheirClient) {
    Edits edits(3);
    edits.add(Edit::reset, 7, {});
    edits.add(Edit::settle, {}, {});
    edits.add(Edit::reset, 8, {});
    EXPECT_EQ(edits.next(), withNumber(4, Edit::reset)) << "3 was the last number of the session before";
    EXPECT_EQ(stepWith({}, edits).client, std::nullopt) << "a step without an edit";
    EXPECT_EQ(stepWith(withNumber(3, Edit::reset), edits).client, std::nullopt) << "an edit of an earlier process";
    EXPECT_EQ(edits.waiting().size(), 3U);
    EXPECT_EQ(stepWith(withNumber(4, Edit::reset), edits).client, 7U);
    EXPECT_EQ(stepWith(withNumber(4, Edit::reset), edits).client, std::nullopt) << "the equal one waits";
    EXPECT_EQ(stepWith(withNumber(6, Edit::reset), edits).client, 8U) << "before its turn";
    EXPECT_EQ(stepWith(withNumber(5, Edit::settle), edits).client, std::nullopt) << "it came from standard input";
    EXPECT_TRUE(edits.waiting().empty());
    EXPECT_FALSE(edits.next().any());
}

TEST(Edits, GiveTheStepTheirMaterial) {
    Edits edits;
    sand::Tuning steep{};
    steep.threshold = 1000;
    scene::Material material;
    material.dryTalus = 33;
    scene::Material nearly = material;
    nearly.dryTalus = 33.00001;  // it gives the same tuning, because a tuning is in whole units
    edits.add(Edit::reset, {}, {});
    edits.add(Edit::tuned(steep), {}, material);
    edits.add(Edit::tuned(steep), {}, nearly);
    EXPECT_EQ(stepWith(withNumber(1, Edit::reset), edits).material, std::nullopt);
    const auto made = stepWith(withNumber(3, Edit::tuned(steep)), edits).material;
    ASSERT_TRUE(made);
    EXPECT_EQ(made->dryTalus, 33.00001) << "and not that of the equal edit";
}

TEST(Edits, AreOneLoadAndSixteenAtMost) {
    Edits edits;
    edits.add(loadOf(100), {}, {});
    EXPECT_THROW(edits.requireRoomFor(loadOf(1)), base::InputError) << "each load holds the whole sand";
    EXPECT_EQ(edits.sandBytes(), 100);
    EXPECT_EQ(edits.sandBytes(loadOf(20)), 120);
    while (edits.waiting().size() < Edits::kMost) {
        EXPECT_NO_THROW(edits.requireRoomFor(Edit::undo));
        edits.add(Edit::undo, {}, {});
    }
    EXPECT_THROW(edits.requireRoomFor(Edit::undo), base::InputError);
}

TEST(Edits, StayWhenTheirClientsAreAnswered) {
    Edits edits;
    edits.add(Edit::reset, 7, {});
    edits.add(Edit::settle, {}, {});
    edits.add(Edit::undo, 9, {});
    EXPECT_EQ(edits.releaseClients(), (std::vector<Edits::Client>{7, 9}));
    EXPECT_TRUE(edits.releaseClients().empty());
    EXPECT_EQ(edits.waiting().size(), 3U);
    EXPECT_EQ(stepWith(withNumber(1, Edit::reset), edits).client, std::nullopt) << "answered already";
}

TEST(Edits, AreAskedForOneByOneAndAgainInANewEpoch) {
    Edits edits;
    EXPECT_EQ(edits.nextToAsk(2), nullptr);
    edits.add(Edit::reset, {}, {});
    edits.add(Edit::settle, {}, {});
    ASSERT_NE(edits.nextToAsk(2), nullptr);
    EXPECT_EQ(edits.nextToAsk(2), nullptr) << "the first one is in no step yet";
    ASSERT_NE(edits.nextToAsk(3), nullptr);
    (void)stepWith(withNumber(1, Edit::reset), edits);
    const Edit* const second = edits.nextToAsk(3);
    ASSERT_NE(second, nullptr);
    EXPECT_EQ(*second, withNumber(2, Edit::settle));
}

}  // namespace
