// SPDX-License-Identifier: Apache-2.0
#include "base/float_environment.hpp"

#include <gtest/gtest.h>

#include <cfenv>
#include <limits>
#include <string>
#include <thread>
#include <utility>

#include "base/float_register.hpp"
#include "tests/support/machine/other_floats.hpp"

namespace {

using namespace base::float_register;

TEST(FloatEnvironment, IsTheDefaultAtFirst) {
    EXPECT_EQ(base::unusualFloats(), "");
    EXPECT_FALSE(base::needDefaultFloats());
}

TEST(FloatEnvironment, NamesAndRepairsEachDifference) {
    const unsigned before = get();
    for (const auto& [bits, words] : {std::pair{kRoundsUp, "rounds up"},
                                      {kRoundsDown, "rounds down"},
                                      {kRoundsTowardZero, "rounds towards zero"},
                                      {kFlushesResults, "flushes subnormal results to zero"},
                                      {kFlushesOperands, "takes subnormal operands as zero"},
                                      {kOneTrap, "traps floating-point exceptions"}}) {
        set(before ^ bits);
        if (get() == before && (bits == kFlushesOperands || bits == kOneTrap)) {
            EXPECT_NE(kDefault, kTraps) << "every x86-64 has this bit";
            continue;
        }
        EXPECT_EQ(base::unusualFloats(), words);
        EXPECT_TRUE(base::needDefaultFloats()) << words;
        EXPECT_EQ(base::unusualFloats(), "");
    }
    std::fesetround(FE_UPWARD);
    if constexpr (kDefault == kTraps) {  // x86-64
        set(before);                     // only the x87 unit still rounds up
    }
    EXPECT_NE(base::unusualFloats(), "");
    EXPECT_TRUE(base::needDefaultFloats());
    EXPECT_EQ(std::fegetround(), FE_TONEAREST);
}

TEST(FloatEnvironment, AnExceptionOfThePastIsNoDifference) {
    volatile double zero = 0;
    const double infinite = 1 / zero;
    EXPECT_EQ(infinite, std::numeric_limits<double>::infinity());
    EXPECT_FALSE(base::needDefaultFloats());
}

// The reason why a worker that was created later must be checked, too.
TEST(FloatEnvironment, AThreadInheritsItFromItsCreator) {
    std::string inherited;
    {
        const test::OtherFloats other;
        std::thread([&] { inherited = base::unusualFloats(); }).join();
    }
    EXPECT_NE(inherited, "");
    EXPECT_EQ(base::unusualFloats(), "");
}

}  // namespace
