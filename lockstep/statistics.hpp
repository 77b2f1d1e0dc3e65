// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace lockstep {

/// Figures of one kind, summed up as people quote them. Keeps a bounded, evenly thinned sample for the percentiles, so
/// that a session of days needs no more memory than one of minutes; mean, deviation and extremes are of all figures.
class Statistics {
public:
    /// `mostKept` figures are kept for the percentiles; it must be even.
    explicit Statistics(std::size_t mostKept = 1 << 13) : mostKept_(mostKept) {}

    void add(double value);

    [[nodiscard]] std::size_t count() const { return count_; }
    [[nodiscard]] double mean() const { return mean_; }
    [[nodiscard]] double deviation() const;
    [[nodiscard]] double largest() const { return largest_; }
    /// The value below which `share` in [0, 1] of the figures lie; 0 when there are none.
    [[nodiscard]] double percentile(double share) const;

private:
    std::size_t mostKept_;
    std::size_t count_ = 0;
    double mean_ = 0;
    double squares_ = 0;  // of the differences from the mean (Welford)
    double largest_ = 0;
    std::size_t every_ = 1;  // one figure in so many is kept
    std::vector<double> kept_;
};

}  // namespace lockstep
