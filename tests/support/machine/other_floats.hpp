// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cfenv>

#include "base/float_register.hpp"

namespace test {

/// Scope in which the calling thread rounds up and takes subnormal numbers as zero, as after loading a library that was
/// compiled with fast-math and left its rounding behind.
class OtherFloats {
public:
    OtherFloats() {
        std::fesetround(FE_UPWARD);
        using namespace base::float_register;
        set(get() | kFlushesResults | kFlushesOperands);
    }
    ~OtherFloats() {
        std::fesetround(FE_TONEAREST);
        base::float_register::set(before_);
    }
    OtherFloats(const OtherFloats&) = delete;
    OtherFloats& operator=(const OtherFloats&) = delete;

private:
    unsigned before_ = base::float_register::get();
};

}  // namespace test
