// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstdint>
#include <span>

#include "tracking/pose.hpp"

namespace tracking {

/// What a packet said.
struct Reading {
    enum class Kind : std::uint8_t {
        pose,
        refused,  // not the format, or absurd
        old,      // overtaken by one that was read before
        absent    // well-formed, but the tracker does not see the head
    };
    Kind kind = Kind::refused;
    Measured measured{};  // for a pose
};

/// Understands the packets of one tracker, in the order in which they come. Reads any bytes without harm.
class PacketReader {
public:
    PacketReader() = default;
    virtual ~PacketReader() = default;
    PacketReader(const PacketReader&) = delete;
    PacketReader& operator=(const PacketReader&) = delete;

    /// `gone`: nothing came for so long that the tracker may have been started anew.
    [[nodiscard]] virtual Reading read(std::span<const std::uint8_t> packet, bool gone) = 0;
};

}  // namespace tracking
