// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pmmintrin.h>
#include <xmmintrin.h>

#include <cfenv>

namespace test {

/// Scope in which the calling thread rounds up and takes subnormal numbers as zero, as after loading a library that was
/// compiled with fast-math and left its rounding behind.
class OtherFloats {
public:
    OtherFloats() {
        std::fesetround(FE_UPWARD);
        _mm_setcsr(_mm_getcsr() | _MM_FLUSH_ZERO_ON | _MM_DENORMALS_ZERO_ON);
    }
    ~OtherFloats() {
        std::fesetround(FE_TONEAREST);
        _mm_setcsr(before_);
    }
    OtherFloats(const OtherFloats&) = delete;
    OtherFloats& operator=(const OtherFloats&) = delete;

private:
    unsigned before_ = _mm_getcsr();
};

}  // namespace test
