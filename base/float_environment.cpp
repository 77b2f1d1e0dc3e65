// SPDX-License-Identifier: Apache-2.0
#include "base/float_environment.hpp"

#include <pmmintrin.h>
#include <xmmintrin.h>

#include <cfenv>

namespace base {
namespace {

// The lowest six bits of the register record exceptions of the past, and do not change a result.
constexpr unsigned kPast = 0x3f;
constexpr unsigned kDefault = 0x1f80;  // all exceptions masked, everything else 0

[[nodiscard]] unsigned control() { return _mm_getcsr() & ~kPast; }

}  // namespace

bool needDefaultFloats() {
    // The second test is for the x87 unit, whose rounding std::fesetround() also sets.
    if (control() == kDefault && std::fegetround() == FE_TONEAREST) {
        return false;
    }
    std::fesetround(FE_TONEAREST);
    _mm_setcsr(kDefault);
    return true;
}

std::string unusualFloats() {
    const unsigned now = control();
    std::string text;
    const auto add = [&text](const char* what) { text += (text.empty() ? "" : ", ") + std::string(what); };
    switch (now & _MM_ROUND_MASK) {
        case _MM_ROUND_DOWN:
            add("rounds down");
            break;
        case _MM_ROUND_UP:
            add("rounds up");
            break;
        case _MM_ROUND_TOWARD_ZERO:
            add("rounds towards zero");
            break;
        default:
            break;
    }
    if ((now & _MM_ROUND_MASK) == _MM_ROUND_NEAREST && std::fegetround() != FE_TONEAREST) {
        add("rounds otherwise than to nearest in the x87 unit");
    }
    if ((now & _MM_FLUSH_ZERO_MASK) != 0) {
        add("flushes subnormal results to zero");
    }
    if ((now & _MM_DENORMALS_ZERO_MASK) != 0) {
        add("takes subnormal operands as zero");
    }
    if ((now & _MM_MASK_MASK) != _MM_MASK_MASK) {
        add("traps floating-point exceptions");
    }
    return text;
}

std::string repairFloats() {
    std::string was = unusualFloats();
    (void)needDefaultFloats();
    return was;
}

}  // namespace base
