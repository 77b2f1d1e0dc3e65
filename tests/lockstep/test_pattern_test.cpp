// SPDX-License-Identifier: Apache-2.0
#include "lockstep/test_pattern.hpp"

#include <gtest/gtest.h>

#include "base/input_error.hpp"

namespace lockstep {
namespace {

TEST(TestPattern, IsFoundByItsName) {
    for (int i = 0; i <= static_cast<int>(kLastPattern); ++i) {
        const auto pattern = static_cast<Pattern>(i);
        EXPECT_EQ(parsePattern(patternName(pattern)), pattern);
    }
}

TEST(TestPattern, ListsTheNamesWhenThereIsNoSuch) {
    try {
        (void)parsePattern("gird");
        FAIL() << "the pattern was found";
    } catch (const base::InputError& error) {
        EXPECT_STREQ(error.what(), "no test pattern 'gird'; there are none, grid, tiles, eyes, flash, ramp");
    }
}

TEST(TestPattern, ComesBackToTheSandAfterTheLast) {
    Pattern pattern = Pattern::none;
    for (std::size_t i = 0; i < kPatternNames.size(); ++i) {
        pattern = nextPattern(pattern);
    }
    EXPECT_EQ(pattern, Pattern::none);
    EXPECT_EQ(nextPattern(Pattern::ramp), Pattern::none);
}

}  // namespace
}  // namespace lockstep
