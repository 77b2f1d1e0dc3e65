// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "haptic_bridge/link/protocol.hpp"

namespace haptic_bridge {

/// Time since the other side of a connection was last heard. All three ends of links use it: server, client and
/// watcher.
///
/// A whole message counts. A part of a long one counts too, because it may take longer than kSilenceNs, and later
/// messages wait for it. The part must have kLeastBytes. Otherwise a peer that sends a byte now and then could hold the
/// link without an end. All times are of one clock [ns].
class Silence {
public:
    static constexpr std::uint64_t kLeastBytes = kMaxMessage;  // [byte], as the longest ordinary message

    explicit Silence(std::int64_t nowNs = 0) : heardNs_(nowNs) {}

    /// Call it for each whole message.
    void heard(std::int64_t nowNs) { heardNs_ = nowNs; }
    /// Call it with the number of bytes that have arrived since the connection began.
    void arrived(std::uint64_t bytes, std::int64_t nowNs) {
        if (bytes >= bytes_ + kLeastBytes) {
            bytes_ = bytes;
            heardNs_ = nowNs;
        }
    }
    [[nodiscard]] std::int64_t lengthNs(std::int64_t nowNs) const { return nowNs - heardNs_; }

private:
    std::int64_t heardNs_;
    std::uint64_t bytes_ = 0;  // number of bytes at the last part that counted
};

}  // namespace haptic_bridge
