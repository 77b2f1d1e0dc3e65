// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace lockstep {

/// Mean, standard deviation, maximum and percentiles of a series of values. The percentiles come from a bounded, evenly
/// thinned sample, so that a session of days needs no more memory than one of minutes. Mean, deviation and maximum are
/// of all values.
class Statistics {
public:
    /// Keeps at most `mostKept` values for the percentiles. `mostKept` must be even.
    explicit Statistics(std::size_t mostKept = 1 << 13) : mostKept_(mostKept) {}

    void add(double value);

    [[nodiscard]] std::size_t count() const { return count_; }
    [[nodiscard]] double mean() const { return mean_; }
    [[nodiscard]] double deviation() const;
    [[nodiscard]] double largest() const { return largest_; }
    /// Returns the value below which the share `share` of all values lies, with `share` in [0, 1]; 0 without values.
    [[nodiscard]] double percentile(double share) const;

private:
    std::size_t mostKept_;
    std::size_t count_ = 0;
    double mean_ = 0;
    double squares_ = 0;  // sum of the squared differences from the mean (Welford)
    double largest_ = 0;
    std::size_t every_ = 1;  // one value in this many is kept
    std::vector<double> kept_;
};

}  // namespace lockstep
