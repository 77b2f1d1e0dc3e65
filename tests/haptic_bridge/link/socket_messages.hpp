// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/socket.h>

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "haptic_bridge/link/message_reader.hpp"
#include "haptic_bridge/link/protocol.hpp"

namespace test {

/// The next message that comes through a plain socket, or nothing when the other side has closed or has said nothing
/// for as long as the socket waits. `reader` holds what came behind the message before.
inline std::optional<haptic_bridge::Message> nextMessage(int socket, haptic_bridge::MessageReader& reader) {
    while (true) {
        if (auto message = reader.next()) {
            return message;
        }
        std::array<std::uint8_t, 4096> chunk{};
        const ssize_t count = recv(socket, chunk.data(), chunk.size(), 0);
        if (count <= 0) {
            return std::nullopt;
        }
        reader.feed(std::span(chunk).first(static_cast<std::size_t>(count)));
    }
}

}  // namespace test
