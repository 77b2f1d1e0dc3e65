// SPDX-License-Identifier: Apache-2.0
#pragma once

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

}  // namespace base
