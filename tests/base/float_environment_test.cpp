// SPDX-License-Identifier: Apache-2.0
#include "base/float_environment.hpp"

#include <gtest/gtest.h>
#include <pmmintrin.h>
#include <xmmintrin.h>

#include <cfenv>
#include <limits>
#include <string>
#include <thread>
#include <utility>

#include "tests/support/other_floats.hpp"

namespace {

TEST(FloatEnvironment, IsTheDefaultAtFirst) {
    EXPECT_EQ(base::unusualFloats(), "");
    EXPECT_FALSE(base::needDefaultFloats());
}

TEST(FloatEnvironment, NamesAndRepairsEachDifference) {
    const unsigned before = _mm_getcsr();
    for (const auto& [bits, words] : {std::pair{_MM_ROUND_UP, "rounds up"},
                                      {_MM_ROUND_DOWN, "rounds down"},
                                      {_MM_ROUND_TOWARD_ZERO, "rounds towards zero"},
                                      {_MM_FLUSH_ZERO_ON, "flushes subnormal results to zero"},
                                      {_MM_DENORMALS_ZERO_ON, "takes subnormal operands as zero"}}) {
        _mm_setcsr(before | static_cast<unsigned>(bits));
        EXPECT_EQ(base::unusualFloats(), words);
        EXPECT_TRUE(base::needDefaultFloats()) << words;
        EXPECT_EQ(base::unusualFloats(), "");
    }
    _mm_setcsr(before & ~static_cast<unsigned>(_MM_MASK_INVALID));
    EXPECT_EQ(base::unusualFloats(), "traps floating-point exceptions");
    EXPECT_TRUE(base::needDefaultFloats());
    std::fesetround(FE_UPWARD);
    _mm_setcsr(before);  // only the x87 unit still rounds up
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
