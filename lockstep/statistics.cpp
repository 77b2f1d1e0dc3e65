// SPDX-License-Identifier: Apache-2.0
#include "lockstep/statistics.hpp"

#include <algorithm>
#include <cmath>

namespace lockstep {

void Statistics::add(double value) {
    if (count_ % every_ == 0) {
        if (kept_.size() == mostKept_) {
            for (std::size_t i = 0; i < mostKept_ / 2; ++i) {
                kept_[i] = kept_[2 * i];
            }
            kept_.resize(mostKept_ / 2);
            every_ *= 2;
        }
        kept_.push_back(value);
    }
    largest_ = count_ == 0 ? value : std::max(largest_, value);
    ++count_;
    const double step = value - mean_;
    mean_ += step / static_cast<double>(count_);
    squares_ += step * (value - mean_);
}

double Statistics::deviation() const { return count_ > 1 ? std::sqrt(squares_ / static_cast<double>(count_ - 1)) : 0; }

double Statistics::percentile(double share) const {
    if (kept_.empty()) {
        return 0;
    }
    std::vector<double> sorted = kept_;
    const std::ptrdiff_t at = std::lround(share * static_cast<double>(sorted.size() - 1));
    std::nth_element(sorted.begin(), sorted.begin() + at, sorted.end());
    return sorted[static_cast<std::size_t>(at)];
}

}  // namespace lockstep
