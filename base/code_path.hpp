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

/// Returns whether this CPU runs code that is compiled for x86-64-v4, which has vectors of 512 bits. Every such CPU has
/// x86-64-v3, too.
inline bool machineHasV4() {
#if defined(__x86_64__)
    return machineHasV3() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl");
#else
    return false;
#endif
}

/// Instruction set of code that is compiled several times. The results are the same with each. Code without a version
/// for v4 takes that for v3 instead.
enum class CodePath : std::uint8_t { baseline, v3, v4 };

constexpr auto valuesOf(CodePath) {
    return std::array{Named{CodePath::baseline, "baseline"}, Named{CodePath::v3, "x86-64-v3"},
                      Named{CodePath::v4, "x86-64-v4"}};
}

/// Returns whether this CPU can run a code path.
inline bool machineHas(CodePath path) {
    return path == CodePath::baseline || (path == CodePath::v3 ? machineHasV3() : machineHasV4());
}

/// Returns the code path with which this CPU is fastest.
inline CodePath fastestCodePath() {
    return machineHasV4() ? CodePath::v4 : machineHasV3() ? CodePath::v3 : CodePath::baseline;
}

}  // namespace base
