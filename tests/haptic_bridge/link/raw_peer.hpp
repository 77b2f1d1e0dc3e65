// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <optional>
#include <span>
#include <string>

#include "haptic_bridge/link/message_reader.hpp"
#include "haptic_bridge/link/protocol.hpp"
#include "tests/haptic_bridge/link/socket_messages.hpp"

namespace test {

/// A plain socket that sends to a server whatever a test wants.
class RawPeer {
public:
    /// Connects to `port` of this machine. `receiveBuffer` limits what the kernel takes before a test reads it [byte];
    /// 0 leaves the limit of the machine, which may be tens of megabytes.
    explicit RawPeer(std::uint16_t port, int receiveBuffer = 0) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(port);
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        const timeval patience{.tv_sec = 10, .tv_usec = 0};
        setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
        if (receiveBuffer > 0) {  // before the connection is made, because its window follows from the buffer
            EXPECT_EQ(setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receiveBuffer, sizeof receiveBuffer), 0);
        }
        EXPECT_EQ(connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    }
    ~RawPeer() { ::close(socket_); }
    RawPeer(const RawPeer&) = delete;
    RawPeer& operator=(const RawPeer&) = delete;

    void send(std::span<const std::uint8_t> bytes) const {
        EXPECT_EQ(::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL), static_cast<ssize_t>(bytes.size()));
    }
    void send(const haptic_bridge::Message& message) const { send(haptic_bridge::encode(message)); }
    /// Returns the next message; nullopt if the server has closed the connection.
    std::optional<haptic_bridge::Message> receive() { return nextMessage(socket_, reader_); }
    std::string refusal() {
        const auto message = receive();
        const auto* refusal = message ? std::get_if<haptic_bridge::Refusal>(&*message) : nullptr;
        return refusal != nullptr ? refusal->text : "(no refusal)";
    }

private:
    int socket_;
    haptic_bridge::MessageReader reader_;
};

}  // namespace test
