// SPDX-License-Identifier: Apache-2.0
#include "base/text.hpp"

#include <gtest/gtest.h>

#include "base/input_error.hpp"

namespace {

using Parts = std::vector<std::string_view>;

TEST(Text, TrimsSpacesTabsAndCarriageReturns) {
    EXPECT_EQ(base::trimmed(" \ta b\r"), "a b");
    EXPECT_EQ(base::trimmed(" \t\r"), "");
    EXPECT_EQ(base::trimmed(""), "");
    EXPECT_EQ(base::trimmed("\na"), "\na");
}

TEST(Text, SplitsAtEverySeparator) {
    EXPECT_EQ(base::split("a, b ,,c\r", ','), (Parts{"a", "b", "", "c"}));
    EXPECT_EQ(base::split("", ','), Parts{""});
    EXPECT_EQ(base::split(",", ','), (Parts{"", ""}));
}

TEST(Text, HasWordsBetweenBlanks) {
    EXPECT_EQ(base::words(" \tone  two\t three\r"), (Parts{"one", "two", "three"}));
    EXPECT_EQ(base::words("one"), Parts{"one"});
    EXPECT_EQ(base::words(" \t\r"), Parts{});
    EXPECT_EQ(base::words(""), Parts{});
}

TEST(Text, WritesSmallLettersOfAsciiAlone) {
    EXPECT_EQ(base::lowerCase("Ab-Z\xC3\x84"), "ab-z\xC3\x84");
    EXPECT_EQ(base::endingOf("folder.d/A.b.TIF"), ".tif");
    EXPECT_EQ(base::endingOf("folder.d/noending"), "");
}

TEST(Text, FindsANameOrListsThemAll) {
    constexpr std::array<std::string_view, 2> kNames{"grid", "tin"};
    EXPECT_EQ(base::indexOf("tin", kNames, "surface"), 1U);
    try {
        (void)base::indexOf("cube", kNames, "surface");
        ADD_FAILURE() << "the unknown name cube was accepted";
    } catch (const base::InputError& error) {
        EXPECT_STREQ(error.what(), "no surface 'cube'; there are grid, tin");
    }
}

}  // namespace
