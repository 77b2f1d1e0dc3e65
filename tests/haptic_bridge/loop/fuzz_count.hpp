// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "haptic_bridge/hand/guard_counts.hpp"

namespace test {

/// Returns how many sequences a fuzzer runs: the number in the environment's `variable`, or `usual`.
inline unsigned sequences(const char* variable, unsigned usual) {
    const char* const given = std::getenv(variable);
    return given == nullptr ? usual : static_cast<unsigned>(std::strtoul(given, nullptr, 10));
}

/// Number of ticks in which each guard acted, in a whole run of a fuzzer.
class ActedCounts {
public:
    void add(std::uint32_t acted) {
        ++ticks_;
        for (std::size_t i = 0; i < haptic_bridge::kGuards; ++i) {
            counts_.at(i) += acted >> i & 1U;
        }
    }
    [[nodiscard]] std::uint64_t of(haptic_bridge::Guard guard) const {
        return counts_.at(static_cast<std::size_t>(guard));
    }
    [[nodiscard]] const std::array<std::uint64_t, haptic_bridge::kGuards>& all() const { return counts_; }
    [[nodiscard]] std::uint64_t ticks() const { return ticks_; }
    /// Prints one line, if the environment asks for a number of sequences.
    void print(const char* variable, const char* fuzzer, unsigned count, unsigned seed) const {
        if (std::getenv(variable) == nullptr) {
            return;
        }
        std::string line =
            fmt::format("{}: {} sequences from SANDWALL_SEED={}, {} ticks; ticks in which each guard acted:", fuzzer,
                        count, seed, ticks_);
        for (std::size_t i = 0; i < haptic_bridge::kGuards; ++i) {
            line +=
                fmt::format("{} {} {}", i == 0 ? "" : ",", valuesOf(haptic_bridge::Guard{}).at(i).name, counts_.at(i));
        }
        fmt::print("{}\n", line);
    }

private:
    std::array<std::uint64_t, haptic_bridge::kGuards> counts_{};
    std::uint64_t ticks_ = 0;
};

}  // namespace test
