// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "tracking/source.hpp"
#include "tracking/udp_socket.hpp"

namespace tracking {

/// A head that goes 20 cm to either side of a point in four seconds and looks back at what it left.
[[nodiscard]] Pose sway(double seconds);

/// Tells a pose in the room as a tracker would: the other end of opentrack: and dtrack: sources.
class PacketSender {
public:
    /// `to` is where to send. Throws base::InputError when it is no tracker that sends, or turns axes.
    explicit PacketSender(const Source& to);
    void send(const Pose& pose);
    [[nodiscard]] std::uint32_t sent() const { return sent_; }

private:
    Source to_;
    UdpSender socket_;
    std::uint32_t sent_ = 0;
};

}  // namespace tracking
