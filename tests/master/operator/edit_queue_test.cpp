// SPDX-License-Identifier: Apache-2.0
#include "master/operator/edit_queue.hpp"

#include <gtest/gtest.h>

#include "base/input_error.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

using master::EditQueue;
using sand::Edit;

using samples::withNumber;

Edit loadOf(std::size_t bytes) { return Edit::loaded(base::Bytes(bytes)); }

TEST(EditQueue, TellsWhoseEditIsShownByItsNumber) {
    EditQueue queue;
    queue.add({withNumber(4, Edit::reset), 7, {}});
    queue.add({withNumber(5, Edit::settle), {}, {}});
    queue.add({withNumber(6, Edit::reset), 8, {}});
    EXPECT_EQ(queue.shown(0), std::nullopt) << "a step without an edit";
    EXPECT_EQ(queue.shown(3), std::nullopt) << "an edit of an earlier process";
    EXPECT_EQ(queue.size(), 3U);
    EXPECT_EQ(queue.shown(4), 7U);
    EXPECT_EQ(queue.shown(4), std::nullopt) << "it was answered already, and the equal one waits";
    EXPECT_EQ(queue.size(), 2U);
    EXPECT_EQ(queue.shown(5), std::nullopt) << "the edit came from standard input";
    EXPECT_EQ(queue.size(), 1U);
    EXPECT_EQ(queue.shown(6), 8U);
    EXPECT_EQ(queue.size(), 0U);
}

TEST(EditQueue, HoldsOneLoadAndSixteenEdits) {
    EditQueue queue;
    queue.add({loadOf(100), {}, {}});
    EXPECT_THROW(queue.requireRoomFor(loadOf(1)), base::InputError) << "each load holds the whole sand";
    EXPECT_EQ(queue.sandBytes(), 100);
    EXPECT_EQ(queue.sandBytes(loadOf(20)), 120);
    while (queue.size() < EditQueue::kMost) {
        EXPECT_NO_THROW(queue.requireRoomFor(Edit::undo));
        queue.add({Edit::undo, {}, {}});
    }
    EXPECT_THROW(queue.requireRoomFor(Edit::undo), base::InputError);
}

TEST(EditQueue, KnowsTheMaterialThatAStepMakes) {
    EditQueue queue;
    sand::Tuning steep{};
    steep.threshold = 1000;
    scene::Material material;
    material.dryTalus = 33;
    scene::Material nearly = material;
    nearly.dryTalus = 33.00001;  // it gives the same tuning, because a tuning is in whole units
    queue.add({withNumber(1, Edit::reset), {}, {}});
    queue.add({withNumber(2, Edit::tuned(steep)), {}, material});
    queue.add({withNumber(3, Edit::tuned(steep)), {}, nearly});
    std::vector<sand::Step> steps(3);
    steps[0].edit = withNumber(1, Edit::reset);
    steps[2].edit = withNumber(3, Edit::tuned(steep));
    const std::vector<scene::Material> made = queue.materialsOf(steps);
    ASSERT_EQ(made.size(), 1U);
    EXPECT_EQ(made[0].dryTalus, 33.00001) << "and not that of the equal edit";
}

TEST(EditQueue, LetsThoseGoWhoWaitAndKeepsTheirEdits) {
    EditQueue queue;
    queue.add({withNumber(1, Edit::reset), 7, {}});
    queue.add({withNumber(2, Edit::settle), {}, {}});
    queue.add({withNumber(3, Edit::undo), 9, {}});
    EXPECT_EQ(queue.releaseClients(), (std::vector<master::ControlSocket::Client>{7, 9}));
    EXPECT_TRUE(queue.releaseClients().empty());
    EXPECT_EQ(queue.size(), 3U);
    EXPECT_EQ(queue.shown(1), std::nullopt) << "answered already";
}

}  // namespace
