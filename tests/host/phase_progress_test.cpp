// SPDX-License-Identifier: Apache-2.0
#include "host/phase_progress.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

namespace {

TEST(PhaseProgress, SpeaksAfterTwoSecondsAndThenEveryTen) {
    constexpr std::int64_t kSecond = 1'000'000'000;
    std::int64_t now = 5 * kSecond;
    std::vector<std::string> lines;
    host::PhaseProgress progress(
        "read", "reads the scene", [&](const std::string& line) { lines.push_back(line); }, [&] { return now; });
    for (int second = 0; second <= 25; ++second) {
        progress.done(second / 100.0);
        progress.done(second / 100.0);
        now += kSecond;
    }
    EXPECT_EQ(lines,
              (std::vector<std::string>{"reads the scene: 2 %", "reads the scene: 12 %", "reads the scene: 22 %"}));
}

TEST(PhaseProgress, IsSilentInAShortPhase) {
    std::int64_t now = 0;
    host::PhaseProgress progress(
        "read", "reads", [](const std::string& line) { ADD_FAILURE() << line; }, [&] { return now; });
    for (; now < 2'000'000'000; now += 100'000'000) {
        progress.done(0.5);
    }
}

}  // namespace
