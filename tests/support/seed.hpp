// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <random>
#include <string>

namespace test {

/// The seed of a random test: another one in each run, or SANDWALL_SEED from the environment.
inline unsigned randomSeed() {
    const char* const given = std::getenv("SANDWALL_SEED");
    return given == nullptr ? std::random_device{}() : static_cast<unsigned>(std::strtoul(given, nullptr, 10));
}

/// For SCOPED_TRACE: how a failing test runs again with the same numbers.
inline std::string again(unsigned seed) { return "run again with SANDWALL_SEED=" + std::to_string(seed); }

}  // namespace test
