// SPDX-License-Identifier: Apache-2.0
#include "master/operator/edit_queue.hpp"

#include <gtest/gtest.h>

#include "base/input_error.hpp"

namespace {

using master::EditQueue;
using sand::Edit;

Edit loadOf(std::size_t bytes) { return Edit::loaded(base::Bytes(bytes)); }

TEST(EditQueue, TellsWhoseEditIsShownInTheOrderOfAsking) {
    EditQueue queue;
    queue.add({Edit::reset, 7, {}});
    queue.add({Edit::settle, {}, {}});
    queue.add({Edit::reset, 8, {}});
    EXPECT_EQ(queue.shown({}), std::nullopt) << "a step without an edit";
    EXPECT_EQ(queue.shown(Edit::settle), std::nullopt) << "the first edit has not been shown";
    EXPECT_EQ(queue.size(), 3U);
    EXPECT_EQ(queue.shown(Edit::reset), 7U);
    EXPECT_EQ(queue.shown(Edit::settle), std::nullopt) << "the edit came from standard input";
    EXPECT_EQ(queue.size(), 1U);
    EXPECT_EQ(queue.shown(Edit::reset), 8U);
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
    queue.add({Edit::reset, {}, {}});
    queue.add({Edit::tuned(steep), {}, material});
    std::vector<sand::Step> steps(3);
    steps[0].edit = Edit::reset;
    steps[2].edit = Edit::tuned(steep);
    const std::vector<scene::Material> made = queue.materialsOf(steps);
    ASSERT_EQ(made.size(), 1U);
    EXPECT_EQ(made[0].dryTalus, 33);
}

TEST(EditQueue, LetsThoseGoWhoWaitAndKeepsTheirEdits) {
    EditQueue queue;
    queue.add({Edit::reset, 7, {}});
    queue.add({Edit::settle, {}, {}});
    queue.add({Edit::undo, 9, {}});
    EXPECT_EQ(queue.releaseClients(), (std::vector<master::ControlSocket::Client>{7, 9}));
    EXPECT_TRUE(queue.releaseClients().empty());
    EXPECT_EQ(queue.size(), 3U);
    EXPECT_EQ(queue.shown(Edit::reset), std::nullopt) << "answered already";
}

}  // namespace
