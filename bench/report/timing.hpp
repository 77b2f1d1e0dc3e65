// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <ctime>
#include <string>
#include <vector>

namespace bench {

/// Returns the CPU time of this thread [s]. It leaves out the time in which other threads used the processor.
inline double cpuSeconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Returns the wall time [s], which measures the work of several threads.
inline double wallSeconds() {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Returns the CPU time of this thread in `work` [s].
template <class Work>
double secondsOf(const Work& work) {
    const double before = cpuSeconds();
    work();
    return cpuSeconds() - before;
}

/// Returns how often a measurement is run whose first run has taken `first` seconds: `most` times below 5 s, three
/// times below 60 s, and else once.
inline int runsFor(double first, int most) { return first < 5 ? most : first < 60 ? std::min(most, 3) : 1; }

/// Returns what `runsFor` does with `most`, for the head of a table.
inline std::string runsRule(int most) {
    return std::to_string(most) + " if the first takes less than 5 s, " + std::to_string(runsFor(5, most)) +
           " if less than 60 s, else 1";
}

/// Returns the value below which `share` of `values` are, by linear interpolation between neighbours. Returns 0 if
/// `values` is empty.
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

/// Median, lowest and highest of several measurements.
struct Spread {
    double median, lowest, highest;
};

inline Spread spreadOf(const std::vector<double>& values) {
    return {quantile(values, 0.5), quantile(values, 0), quantile(values, 1)};
}

}  // namespace bench
