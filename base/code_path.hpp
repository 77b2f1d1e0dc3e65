// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace base {

/// Whether this machine runs what is compiled for x86-64-v3.
inline bool machineHasV3() {
    // clang 14 knows no "x86-64-v3" here; these three stand for it on every processor that was ever sold.
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
}

}  // namespace base
