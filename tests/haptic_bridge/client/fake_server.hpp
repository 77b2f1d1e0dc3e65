// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <thread>
#include <utility>
#include <variant>

#include "haptic_bridge/client/client.hpp"
#include "haptic_bridge/link/message_reader.hpp"
#include "tests/haptic_bridge/link/socket_messages.hpp"

namespace test {

/// A listening socket. Each connection gets one conversation, on a thread of the server's own.
class FakeServer {
public:
    struct Connection {
        int socket;
        haptic_bridge::MessageReader reader;

        /// Returns whether the client was still connected.
        bool send(std::span<const std::uint8_t> bytes) const {  // NOLINT(modernize-use-nodiscard)
            return ::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL) >= 0;
        }
        void send(const haptic_bridge::Message& message) const { send(haptic_bridge::encode(message)); }
        /// Returns the next message; nullopt if the client has disconnected.
        std::optional<haptic_bridge::Message> next() { return nextMessage(socket, reader); }
        /// Reads until a message of this kind comes. Returns nullopt if the client has disconnected.
        template <class Kind>
        std::optional<Kind> await() {
            while (const auto message = next()) {
                if (const Kind* wanted = std::get_if<Kind>(&*message)) {
                    return *wanted;
                }
            }
            return std::nullopt;
        }
        /// Discards what the client sends, until it disconnects.
        void ignoreTheRest() const {
            std::array<std::uint8_t, 4096> chunk{};
            ssize_t count = 0;
            do {
                count = recv(socket, chunk.data(), chunk.size(), 0);
            } while (count > 0 || (count < 0 && errno == EAGAIN));
        }
    };

    explicit FakeServer(std::function<void(Connection&)> talk) : talk_(std::move(talk)) {
        socket_ = socket(AF_INET, SOCK_STREAM, 0);
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof address;
        EXPECT_EQ(bind(socket_, reinterpret_cast<const sockaddr*>(&address), size), 0);
        EXPECT_EQ(listen(socket_, 8), 0);
        EXPECT_EQ(getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size), 0);
        port_ = ntohs(address.sin_port);
        thread_ = std::thread([this] { serve(); });
    }
    ~FakeServer() {
        shutdown(socket_, SHUT_RDWR);
        thread_.join();
        close(socket_);
    }
    FakeServer(const FakeServer&) = delete;
    FakeServer& operator=(const FakeServer&) = delete;

    [[nodiscard]] haptic_bridge::Address address() const { return {"127.0.0.1", port_}; }
    [[nodiscard]] int connections() const { return connections_; }

private:
    void serve() {
        while (true) {
            Connection connection{accept(socket_, nullptr, nullptr), {}};
            if (connection.socket < 0) {
                return;
            }
            const timeval patience{.tv_sec = 5, .tv_usec = 0};
            setsockopt(connection.socket, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
            ++connections_;
            talk_(connection);
            // Closing with an unread Ping would reset the connection, and the client would lose the last messages.
            shutdown(connection.socket, SHUT_WR);
            connection.ignoreTheRest();
            close(connection.socket);
        }
    }

    std::function<void(Connection&)> talk_;
    int socket_ = -1;
    std::uint16_t port_ = 0;
    std::atomic<int> connections_{0};
    std::thread thread_;
};

/// Talks only on the first connection. Later connections get silence until they end. For tests of the end of one
/// conversation, because the client connects again, and a second conversation would change the result.
inline std::function<void(FakeServer::Connection&)> toTheFirst(std::function<void(FakeServer::Connection&)> talk) {
    return [talk = std::move(talk), first = true](FakeServer::Connection& connection) mutable {
        if (std::exchange(first, false)) {
            talk(connection);
            return;
        }
        connection.ignoreTheRest();
    };
}

}  // namespace test
