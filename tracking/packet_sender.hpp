// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "tracking/source.hpp"
#include "tracking/udp_socket.hpp"

namespace tracking {

/// Returns the pose of a head that sways 20 cm to either side of a point in four seconds, and turns back to the point.
[[nodiscard]] Pose sway(double seconds);

/// Sender of poses in the room, in the packets of a tracker. It is the other end of the sources opentrack: and dtrack:.
class PacketSender {
public:
    /// Sends to `to`. Throws base::InputError if `to` is not opentrack: or dtrack:, if it turns axes, or if its port is
    /// 0.
    explicit PacketSender(const Source& to);
    void send(const Pose& pose);
    [[nodiscard]] std::uint32_t sent() const { return sent_; }

private:
    Source to_;
    UdpSender socket_;
    std::uint32_t sent_ = 0;
};

}  // namespace tracking
