// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <string>

namespace test {

/// Returns the seed of a random test: SANDWALL_SEED from the environment, or the same one in each run, so that a commit
/// passes or fails in every run alike.
inline unsigned randomSeed() {
    constexpr unsigned kUsual = 2718281828;
    const char* const given = std::getenv("SANDWALL_SEED");
    return given == nullptr ? kUsual : static_cast<unsigned>(std::strtoul(given, nullptr, 10));
}

/// Returns a message for SCOPED_TRACE that shows how to run a failed test again with the same numbers.
inline std::string again(unsigned seed) { return "run again with SANDWALL_SEED=" + std::to_string(seed); }

}  // namespace test
