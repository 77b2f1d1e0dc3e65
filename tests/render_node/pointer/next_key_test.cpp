// SPDX-License-Identifier: Apache-2.0
#include "render_node/pointer/next_key.hpp"

#include <gtest/gtest.h>

namespace {

using base::Keystroke;
using render_node::takeNextKey;
using Keys = std::vector<Keystroke>;

constexpr Keystroke kPlus{'+', 0, 0}, kMinus{'-', 0, 0}, kQuit{'q', Keystroke::kControl, 0};

TEST(NextKey, IsTheOldestOne) {
    Keys waiting{kPlus, kMinus};
    EXPECT_EQ(takeNextKey(waiting), kPlus);
    EXPECT_EQ(takeNextKey(waiting), kMinus);
    EXPECT_EQ(takeNextKey(waiting), Keystroke{});
}

TEST(NextKey, ThatEndsTheSessionDoesNotWaitForOthers) {
    Keys waiting{kPlus, kPlus, kQuit, kPlus};
    EXPECT_EQ(takeNextKey(waiting), kQuit);
    EXPECT_EQ(waiting, Keys(3, kPlus));
}

TEST(NextKey, OfAHeldKeyIsDroppedBeyondAFew) {
    Keys waiting(100, kPlus);
    waiting.push_back(kQuit);
    EXPECT_EQ(takeNextKey(waiting), kQuit) << "also behind the others";
    EXPECT_EQ(waiting, Keys(render_node::kMostKeys, kPlus));
}

}  // namespace
