// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "base/byte_stream.hpp"
#include "tracking/packet_reader.hpp"

namespace tracking {

/// ART's DTrack, output in ASCII: a line "fr NUMBER" and, in "6d COUNT" and COUNT bodies, [number quality], [x y z and
/// three angles], [nine numbers of the rotation, column by column]; positions in millimetres. Other lines are skipped.
///
/// Frames that are not newer than the newest are old. Far behind it, or after a silence, they are those of a DTrack
/// that was started anew. Packets without a frame number are taken as they come.
class DtrackReader : public PacketReader {
public:
    explicit DtrackReader(int body) : body_(body) {}
    [[nodiscard]] Reading read(std::span<const std::uint8_t> packet, bool gone) override;

private:
    [[nodiscard]] bool newer(std::uint32_t frame, bool gone) const;

    int body_;
    std::optional<std::uint32_t> newest_;
};

/// The packet of a tracker whose axes are the room's, with this body alone. A pose knows no pitch.
[[nodiscard]] base::Bytes dtrackPacket(const Pose& pose, std::uint32_t frame, int body);

}  // namespace tracking
