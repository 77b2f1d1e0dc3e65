// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

namespace haptic_bridge {

/// Limit of the rate of messages: `perSecond` messages per second, and as many in one burst. Times are [ns] of one
/// monotonic clock.
class RateLimit {
public:
    RateLimit(double perSecond, std::int64_t nowNs) : rate_(perSecond), allowed_(perSecond), countedNs_(nowNs) {}

    void setRate(double perSecond) { rate_ = allowed_ = perSecond; }
    /// Returns whether one more message may come. Calls `now` only if none is left, because reading the clock takes
    /// longer than a message.
    template <class Now>
    [[nodiscard]] bool allows(const Now& now) {
        if (allowed_ < 1) {
            const std::int64_t nowNs = now();
            allowed_ = std::min(rate_, allowed_ + static_cast<double>(nowNs - countedNs_) * 1e-9 * rate_);
            countedNs_ = nowNs;
        }
        return allowed_ >= 1;
    }
    /// Counts `messages` messages, or an equal cost.
    void use(double messages) { allowed_ -= messages; }

private:
    double rate_, allowed_;  // [1/s], [message]
    std::int64_t countedNs_;
};

}  // namespace haptic_bridge
