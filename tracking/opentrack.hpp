// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/byte_stream.hpp"
#include "tracking/packet_reader.hpp"

namespace tracking {

/// opentrack's "UDP over network": six little-endian doubles, x, y, z [cm] and yaw, pitch, roll [degree].
///
/// opentrack counts x to the user's left, y up, z away from the screen, yaw to the right, pitch up, roll to the left.
/// Here x and yaw are reversed, so that the axes are the room's for a user who faces the wall.
class OpentrackReader : public PacketReader {
public:
    [[nodiscard]] Reading read(std::span<const std::uint8_t> packet, bool gone) override;
};

/// The packet in which a head of this pose, in front of the camera, would be told. A pose knows no pitch.
[[nodiscard]] base::Bytes opentrackPacket(const Pose& pose);

}  // namespace tracking
