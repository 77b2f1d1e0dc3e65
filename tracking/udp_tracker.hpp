// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "tracking/head_tracker.hpp"
#include "tracking/packet_reader.hpp"
#include "tracking/udp_socket.hpp"

namespace tracking {

/// A tracker that sends packets: every look drains the socket down to the newest one. No thread, no lock.
class UdpTracker : public HeadTracker {
public:
    UdpTracker(const Source& source, const RoomMapping& mapping, std::unique_ptr<PacketReader> reader, Say say,
               Clock clock);
    [[nodiscard]] std::optional<Pose> newest(double seconds) override;
    [[nodiscard]] Counters counters() const override;
    [[nodiscard]] std::uint16_t port() const override { return receiver_.port(); }

    static constexpr int kMostPackets = 1000;  // read in one look, so that a flood cannot hold the frame up

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
