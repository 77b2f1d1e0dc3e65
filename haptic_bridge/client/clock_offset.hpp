// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace haptic_bridge {

/// Estimate of how far another host's clock is ahead of this one. It takes the exchange with the shortest round trip
/// among the latest 64, because the two directions of that exchange can differ least. The error is at most half of that
/// round trip.
class ClockOffset {
public:
    void add(std::int64_t sentNs, std::int64_t otherNs, std::int64_t receivedNs) {
        exchanges_[next_ % exchanges_.size()] = {receivedNs - sentNs, otherNs - (sentNs + (receivedNs - sentNs) / 2)};
        ++next_;
        const std::size_t count = next_ < exchanges_.size() ? next_ : exchanges_.size();
        best_ = exchanges_[0];
        for (std::size_t i = 1; i < count; ++i) {
            best_ = exchanges_[i].roundTripNs < best_.roundTripNs ? exchanges_[i] : best_;
        }
    }
    [[nodiscard]] std::int64_t offsetNs() const { return best_.offsetNs; }  // [ns], other − own; 0 at first
    [[nodiscard]] std::int64_t roundTripNs() const { return best_.roundTripNs; }

private:
    struct Exchange {
        std::int64_t roundTripNs = 0, offsetNs = 0;
    };
    std::array<Exchange, 64> exchanges_{};
    std::size_t next_ = 0;
    Exchange best_;
};

}  // namespace haptic_bridge
