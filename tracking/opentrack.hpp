// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/byte_stream.hpp"
#include "tracking/packet_reader.hpp"

namespace tracking {

/// Reader of opentrack's "UDP over network" packets: six little-endian doubles, x, y, z [cm] and yaw, pitch, roll
/// [degree].
///
/// opentrack's x points to the user's left, y up, z away from the screen. Its yaw turns right, pitch up, roll left. The
/// reader reverses x and yaw, so that the axes are the room's for a user who faces the wall.
class OpentrackReader : public PacketReader {
public:
    [[nodiscard]] Reading read(std::span<const std::uint8_t> packet, bool gone) override;
};

/// Returns the packet of a tracker that measures this pose in front of the camera. The pitch is 0, because a pose has
/// none.
[[nodiscard]] base::Bytes opentrackPacket(const Pose& pose);

}  // namespace tracking
