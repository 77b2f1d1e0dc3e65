// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "tracking/head_tracker.hpp"
#include "tracking/packet_reader.hpp"
#include "tracking/udp_socket.hpp"

namespace tracking {

/// Tracker that sends packets. Each read empties the socket and keeps the newest pose. No thread, no lock.
class UdpTracker : public HeadTracker {
public:
    UdpTracker(const Source& source, const RoomMapping& mapping, std::unique_ptr<PacketReader> reader, Print print,
               Clock clock);
    [[nodiscard]] std::optional<Pose> newest(double seconds) override;
    [[nodiscard]] Counters counters() const override;
    [[nodiscard]] std::uint16_t port() const override { return receiver_.port(); }

    // Largest number of packets in one read, so that a flood cannot delay the frame.
    static constexpr int kMostPackets = 1000;

private:
    [[nodiscard]] bool take(std::span<const std::uint8_t> packet, bool gone);

    RoomMapping mapping_;
    UdpReceiver receiver_;
    std::unique_ptr<PacketReader> reader_;
    Clock clock_;
    Presence presence_;
    Counters counters_;
    std::optional<Pose> last_;
};

}  // namespace tracking
