// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <random>
#include <string>

namespace test {

/// Returns the seed of a random test: SANDWALL_SEED from the environment, or another one in each run.
inline unsigned randomSeed() {
    const char* const given = std::getenv("SANDWALL_SEED");
    return given == nullptr ? std::random_device{}() : static_cast<unsigned>(std::strtoul(given, nullptr, 10));
}

/// Returns a message for SCOPED_TRACE that shows how to run a failed test again with the same numbers.
inline std::string again(unsigned seed) { return "run again with SANDWALL_SEED=" + std::to_string(seed); }

}  // namespace test
