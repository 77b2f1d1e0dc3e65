// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "base/names.hpp"

namespace base {

/// Returns whether this CPU runs code that is compiled for x86-64-v3. On another processor than x86-64 it is false, and
/// both versions of the code are the same there.
inline bool machineHasV3() {
#if defined(__x86_64__)
    // clang 14 does not know "x86-64-v3" here. Every CPU that was sold with these three has all of x86-64-v3.
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
#else
    return false;
#endif
}

/// Instruction set of code that is compiled twice. The results are the same with each. Only a CPU for which
/// machineHasV3() is true can run `v3`.
enum class CodePath : std::uint8_t { baseline, v3 };

constexpr auto valuesOf(CodePath) {
    return std::array{Named{CodePath::baseline, "baseline"}, Named{CodePath::v3, "x86-64-v3"}};
}

/// Returns the code path with which this CPU is fastest.
inline CodePath fastestCodePath() { return machineHasV3() ? CodePath::v3 : CodePath::baseline; }

}  // namespace base
