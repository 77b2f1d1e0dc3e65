// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstdint>
#include <span>

#include "tracking/pose.hpp"

namespace tracking {

/// Content of a packet.
struct Reading {
    enum class Kind : std::uint8_t {
        pose,
        refused,  // wrong format, or implausible
        old,      // a newer packet was read before
        absent    // well-formed, but the tracker does not see the head
    };
    Kind kind = Kind::refused;
    Measured measured{};  // valid for Kind::pose
};

/// Reader of one tracker's packets, in their order of arrival. Any bytes are safe to read.
class PacketReader {
public:
    PacketReader() = default;
    virtual ~PacketReader() = default;
    PacketReader(const PacketReader&) = delete;
    PacketReader& operator=(const PacketReader&) = delete;

    /// Reads a packet. `gone` tells that no pose came for so long that the tracker may have been restarted.
    [[nodiscard]] virtual Reading read(std::span<const std::uint8_t> packet, bool gone) = 0;
};

}  // namespace tracking
