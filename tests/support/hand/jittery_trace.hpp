// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdio>
#include <functional>
#include <random>
#include <string>

namespace test {

/// Returns the trace of a hand, recorded as real devices do at a nominal 1 kHz. Periods are 1.017 ms on average and
/// sometimes 2 ms. Rare gaps last up to 20 ms, and now and then two ticks are only 8 µs apart. `place` returns the
/// place of the hand at a time [s].
inline std::string jitteryTrace(unsigned seed, double seconds,
                                const std::function<std::array<double, 3>(double)>& place) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0, 1);
    std::string text = "time,x,y,z\n";
    double time = 0;
    while (time < seconds) {
        const auto at = place(time);
        std::array<char, 160> line{};
        std::snprintf(line.data(), line.size(), "%.9f,%.9f,%.9f,%.9f\n", time, at[0], at[1], at[2]);
        text += line.data();
        const double luck = uniform(random);
        if (luck < 0.002) {
            time += 0.002 + 0.018 * uniform(random);
        } else if (luck < 0.004) {
            time += 8e-6;
        } else {
            time += luck < 0.02 ? 0.0022 : 0.0009 + 0.0002 * uniform(random);
        }
    }
    return text;
}

}  // namespace test
