// SPDX-License-Identifier: Apache-2.0
#include "base/number.hpp"

#include <gtest/gtest.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <random>

#include "base/input_error.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/seed.hpp"

namespace {

TEST(Number, FillsTheWord) {
    EXPECT_EQ(base::numberOf("-2.5e3"), -2500);
    EXPECT_EQ(base::numberOf("0"), 0);
    EXPECT_EQ(base::numberOf("+1.5"), 1.5);
    EXPECT_EQ(base::numberOf("+.5"), 0.5);
    EXPECT_EQ(base::numberOf("5."), 5);
    for (const char* word : {"", "x", "1x", " 1", "1 ", "+", "-", "++1", "+-1", "-+1", "1,5", "nan", "inf", "+inf",
                             "1e999", "0x10", "1e", "."}) {
        EXPECT_EQ(base::numberOf(word), std::nullopt) << word;
    }
}

TEST(Number, IsReadToTheLastBit) {
    // std::to_chars writes the shortest text that only this double has.
    const unsigned seed = test::randomSeed();
    SCOPED_TRACE(test::again(seed));
    std::mt19937_64 random(seed);
    for (int i = 0; i < 20000; ++i) {
        const std::uint64_t bits = random();
        double number = 0;
        std::memcpy(&number, &bits, sizeof number);
        if (!std::isfinite(number)) {
            continue;
        }
        std::array<char, 64> text{};
        const char* const end = std::to_chars(text.data(), text.data() + text.size(), number).ptr;
        const std::string word(text.data(), static_cast<std::size_t>(end - text.data()));
        EXPECT_EQ(base::numberOf(word), number) << word;
    }
}

TEST(Number, MayHaveADecimalComma) {
    EXPECT_EQ(base::commaNumberOf("1,5"), 1.5);
    EXPECT_EQ(base::commaNumberOf("-0,25e2"), -25);
    EXPECT_EQ(base::commaNumberOf("+1,5"), 1.5);
    for (const char* word : {"", "1", "1.5", "1,", ",5", "1,234.5", "1,2,3", "a,5", "1,5x"}) {
        EXPECT_EQ(base::commaNumberOf(word), std::nullopt) << word;
    }
}

TEST(Number, AllOfAFileHaveOneDecimalSign) {
    base::DecimalStyle points("p.csv");
    EXPECT_EQ(points.numberOf("1", 1), 1);
    EXPECT_EQ(points.numberOf("2.5", 2), 2.5);
    EXPECT_EQ(points.numberOf("x", 3), std::nullopt);
    const std::string refused = test::refusalOf([&] { (void)points.numberOf("1,234", 4); });
    EXPECT_EQ(refused,
              "p.csv:4: '1,234' in line 4 has a decimal comma, and '2.5' in line 2 a decimal point, so that the comma "
              "could separate thousands; write decimal points in all numbers");
    base::DecimalStyle commas("p.csv");
    EXPECT_EQ(commas.numberOf("1,5", 1), 1.5);
    EXPECT_EQ(commas.numberOf("7", 2), 7);
    EXPECT_NE(test::refusalOf([&] { (void)commas.numberOf("2.5", 3); }).find("p.csv:3: '1,5' in line 1"),
              std::string::npos);
}

TEST(Number, NotANumberHasTheSpellingsOfManyLibraries) {
    for (const char* word : {"nan", "NaN", "-nan", "+NAN", "nan(0x8000)", "-nan(ind)", "1.#QNAN", "1.#SNAN", "-1.#IND",
                             "1.#NAN", "1.#IND00"}) {
        EXPECT_TRUE(base::spellsNan(word)) << word;
    }
    for (const char* word : {"", "-", "nano", "inf", "0", "1.#INF", "banana", "nan(", "--nan"}) {
        EXPECT_FALSE(base::spellsNan(word)) << word;
    }
}

}  // namespace
