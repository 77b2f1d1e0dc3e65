// SPDX-License-Identifier: Apache-2.0
#include "base/index_set.hpp"

#include <gtest/gtest.h>

namespace {

TEST(IndexSet, TellsNewIndicesFromKnownOnesAndForgetsThem) {
    base::IndexSet set;
    set.reserve(4);
    EXPECT_TRUE(set.insertReserved(3));
    EXPECT_FALSE(set.insert(3));
    EXPECT_TRUE(set.insert(1000));
    EXPECT_FALSE(set.insert(1000));
    set.clear();
    EXPECT_TRUE(set.insert(3));
    EXPECT_TRUE(set.insert(1000));
}

TEST(IndexList, KeepsTheOrderInWhichIndicesCameFirst) {
    base::IndexList list;
    list.add(5);
    list.add({2, 5, 7, 2});
    EXPECT_EQ(list.all(), (std::vector{5, 2, 7}));
    list.clear();
    EXPECT_TRUE(list.all().empty());
    list.add(2);
    EXPECT_EQ(list.all(), std::vector{2});
}

}  // namespace
