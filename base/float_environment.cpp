// SPDX-License-Identifier: Apache-2.0
#include "base/float_environment.hpp"

#if defined(__wasm__)
// WebAssembly always rounds to nearest, keeps subnormal numbers and has no traps.
namespace base {

bool needDefaultFloats() { return false; }
std::string unusualFloats() { return {}; }
std::string repairFloats() { return {}; }

}  // namespace base
#else
#include <cfenv>

#include "base/float_register.hpp"

namespace base {
namespace {

[[nodiscard]] unsigned control() { return float_register::get() & ~float_register::kPast; }

}  // namespace

bool needDefaultFloats() {
    // The second test is for the x87 unit of x86-64, whose rounding std::fesetround() also sets.
    if (control() == float_register::kDefault && std::fegetround() == FE_TONEAREST) {
        return false;
    }
    std::fesetround(FE_TONEAREST);
    float_register::set(float_register::kDefault);
    return true;
}

std::string unusualFloats() {
    const unsigned now = control();
    std::string text;
    const auto add = [&text](const char* what) { text += (text.empty() ? "" : ", ") + std::string(what); };
    switch (now & float_register::kRounding) {
        case float_register::kRoundsDown:
            add("rounds down");
            break;
        case float_register::kRoundsUp:
            add("rounds up");
            break;
        case float_register::kRoundsTowardZero:
            add("rounds towards zero");
            break;
        default:
            break;
    }
    if ((now & float_register::kRounding) == 0 && std::fegetround() != FE_TONEAREST) {
        add("rounds otherwise than to nearest in the x87 unit");
    }
    if ((now & float_register::kFlushesResults) != 0) {
        add("flushes subnormal results to zero");
    }
    if ((now & float_register::kFlushesOperands) != 0) {
        add("takes subnormal operands as zero");
    }
    if ((now & float_register::kTraps) != (float_register::kDefault & float_register::kTraps)) {
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
#endif
