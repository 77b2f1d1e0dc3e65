// SPDX-License-Identifier: Apache-2.0
#include "render_node/pointer/next_key.hpp"

#include <gtest/gtest.h>

namespace {

TEST(NextKey, IsTheOldestOne) {
    std::string waiting = "ab";
    EXPECT_EQ(render_node::takeNextKey(waiting, 'q'), 'a');
    EXPECT_EQ(render_node::takeNextKey(waiting, 'q'), 'b');
    EXPECT_EQ(render_node::takeNextKey(waiting, 'q'), '\0');
}

TEST(NextKey, ThatEndsTheSessionDoesNotWaitForOthers) {
    std::string waiting = "++q+";
    EXPECT_EQ(render_node::takeNextKey(waiting, 'q'), 'q');
    EXPECT_EQ(waiting, "+++");
}

TEST(NextKey, OfAHeldKeyIsDroppedBeyondAFew) {
    std::string waiting = std::string(100, '+') + "q";
    EXPECT_EQ(render_node::takeNextKey(waiting, 'q'), 'q') << "also behind the others";
    EXPECT_EQ(waiting, std::string(render_node::kMostKeys, '+'));
}

}  // namespace
