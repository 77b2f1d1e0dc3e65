// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace haptic_bridge {

/// Time since the other side of a connection was last heard.
///
/// Any of its bytes count, because a message with sand may take longer than kSilenceNs, and the messages after it wait
/// for it. All times are of one clock [ns].
class Silence {
public:
    explicit Silence(std::int64_t nowNs = 0) : heardNs_(nowNs) {}

    void heard(std::int64_t nowNs) { heardNs_ = nowNs; }
    /// Call it with the number of bytes that have arrived since the connection began.
    void arrived(std::uint64_t bytes, std::int64_t nowNs) {
        if (bytes != bytes_) {
            bytes_ = bytes;
            heardNs_ = nowNs;
        }
    }
    [[nodiscard]] std::int64_t lengthNs(std::int64_t nowNs) const { return nowNs - heardNs_; }

private:
    std::int64_t heardNs_;
    std::uint64_t bytes_ = 0;
};

}  // namespace haptic_bridge
