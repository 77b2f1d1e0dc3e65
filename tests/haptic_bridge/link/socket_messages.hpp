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

/// Returns the next message from a plain socket. Returns nullopt if the other side has closed it, or is silent for
/// longer than the socket waits. `reader` keeps bytes that came after the previous message.
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
