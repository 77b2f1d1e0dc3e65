// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/input_error.hpp"
#include "base/names.hpp"

namespace base {

/// Instruction set of code that is compiled several times. The results are the same with each. x86-64-v4 has vectors of
/// 512 bits. Code without a version for v4 takes that for v3 instead.
enum class CodePath : std::uint8_t { baseline, v3, v4 };

constexpr auto valuesOf(CodePath) {
    return std::array{Named{CodePath::baseline, "baseline"}, Named{CodePath::v3, "x86-64-v3"},
                      Named{CodePath::v4, "x86-64-v4"}};
}

/// Returns whether this CPU can run a code path. Another processor than x86-64 has only the baseline, because all
/// versions of the code are the same there.
inline bool machineHas(CodePath path) {
    if (path == CodePath::baseline) {
        return true;
    }
#if defined(__x86_64__)
    // clang 14 does not know "x86-64-v3" here. Every CPU that was sold with these three has all of x86-64-v3.
    const bool v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
    const bool v4 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                    __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                    __builtin_cpu_supports("avx512vl");
    return v3 && (path == CodePath::v3 || v4);
#else
    return false;
#endif
}

/// Returns the code paths that this CPU can run, the fastest one last.
inline std::vector<CodePath> codePathsHere() {
    std::vector<CodePath> here;
    for (const Named<CodePath>& known : valuesOf(CodePath{})) {
        if (machineHas(known.value)) {
            here.push_back(known.value);
        }
    }
    return here;
}

/// Returns the code path with which this CPU is fastest.
inline CodePath fastestCodePath() {
    return machineHas(CodePath::v4) ? CodePath::v4 : machineHas(CodePath::v3) ? CodePath::v3 : CodePath::baseline;
}

/// Returns the path that the user chose with the option --path. Throws InputError if it is not one of `here`.
inline CodePath chosenCodePath(CodePath path, const std::vector<CodePath>& here = codePathsHere()) {
    std::string names;
    for (const CodePath known : here) {
        if (known == path) {
            return path;
        }
        names += (names.empty() ? "" : ", ") + std::string(nameOf(known));
    }
    throw InputError("--path " + std::string(nameOf(path)) + ": this processor does not have it; choose from " + names);
}

}  // namespace base
