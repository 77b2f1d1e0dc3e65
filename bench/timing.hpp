// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <ctime>
#include <vector>

namespace bench {

/// Time that this thread has computed [s]. Of one thread it is what a quiet machine's clock would show, and it does
/// not count the time for which others had the processor.
inline double cpuSeconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Time on the wall [s], for what several threads do together.
inline double wallSeconds() {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Seconds of this thread that `work` takes.
template <class Work>
double secondsOf(const Work& work) {
    const double before = cpuSeconds();
    work();
    return cpuSeconds() - before;
}

/// The value below which `share` of the values lie, between neighbours by linear interpolation. None give 0.
inline double quantile(std::vector<double> values, double share) {
    if (values.empty()) {
        return 0;
    }
    std::sort(values.begin(), values.end());
    const double place = share * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const auto above = std::min(below + 1, values.size() - 1);
    return values[below] + (place - std::floor(place)) * (values[above] - values[below]);
}

/// Several measurements of one thing.
struct Spread {
    double median, lowest, highest;
};

inline Spread spreadOf(const std::vector<double>& values) {
    return {quantile(values, 0.5), quantile(values, 0), quantile(values, 1)};
}

}  // namespace bench
