// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "base/byte_stream.hpp"
#include "tracking/packet_reader.hpp"

namespace tracking {

/// Reader of packets of ART's DTrack in ASCII. A packet has a line "fr NUMBER" and a line "6d COUNT" with COUNT bodies.
/// A body is [number quality] [x y z and three angles] [nine numbers of the rotation, column by column]. Positions are
/// in millimetres. Other lines are skipped.
///
/// A frame that is not newer than the newest one is old. If it is far behind the newest one, or if it comes after a
/// silence, DTrack has been restarted, and the frame counts as new. Packets without a frame number are read in the
/// order in which they arrive.
class DtrackReader : public PacketReader {
public:
    explicit DtrackReader(int body) : body_(body) {}
    [[nodiscard]] Reading read(std::span<const std::uint8_t> packet, bool gone) override;

private:
    [[nodiscard]] bool newer(std::uint32_t frame, bool gone) const;

    int body_;
    std::optional<std::uint32_t> newest_;
};

/// Returns the packet of a tracker whose axes are the room's, with this body only. The pitch is 0, because a pose has
/// none.
[[nodiscard]] base::Bytes dtrackPacket(const Pose& pose, std::uint32_t frame, int body);

}  // namespace tracking
