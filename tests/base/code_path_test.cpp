// SPDX-License-Identifier: Apache-2.0
#include "base/code_path.hpp"

#include <gtest/gtest.h>

namespace {

using base::CodePath;

TEST(CodePath, TheFastestOfThisProcessorIsTheLastThatItHas) {
    const std::vector<CodePath> here = base::codePathsHere();
    ASSERT_FALSE(here.empty());
    EXPECT_EQ(here.front(), CodePath::baseline);
    EXPECT_EQ(here.back(), base::fastestCodePath());
}

TEST(CodePath, AChosenOneThatThisProcessorLacksIsRefusedInOneLine) {
    const std::vector<CodePath> here{CodePath::baseline, CodePath::v3};
    EXPECT_EQ(base::chosenCodePath(CodePath::v3, here), CodePath::v3);
    try {
        (void)base::chosenCodePath(CodePath::v4, here);
        ADD_FAILURE() << "the path was taken";
    } catch (const base::InputError& error) {
        EXPECT_STREQ(error.what(),
                     "--path x86-64-v4: this processor does not have it; choose from baseline, x86-64-v3");
    }
}

}  // namespace
