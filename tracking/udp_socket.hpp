// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tracking {

/// Datagrams that have arrived at a port of this machine. Never waits.
class UdpReceiver {
public:
    /// `host` is an IP address; datagrams are taken from the address `from` alone, which may be left empty where `host`
    /// is loopback. Throws base::InputError that begins with `who` when it is, and when the port cannot be had.
    UdpReceiver(const std::string& host, std::uint16_t port, const std::string& from, const std::string& who);
    /// The next datagram, whole, valid until the next call; nothing when none is there. A failure counts as none, and
    /// so does one from elsewhere.
    [[nodiscard]] std::optional<std::span<const std::uint8_t>> next();
    [[nodiscard]] std::uint16_t port() const { return port_; }
    /// Datagrams from elsewhere, and those for which the kernel had no room.
    [[nodiscard]] std::uint64_t strangers() const;

private:
    boost::asio::io_context io_;
    boost::asio::ip::udp::socket socket_{io_};
    std::optional<boost::asio::ip::address> from_;
    std::uint64_t strangers_ = 0;
    std::vector<std::uint8_t> buffer_;
    std::uint16_t port_ = 0;
    int native_ = -1;  // socket_, for what only reads its counts
};

/// Sends datagrams to one address. Throws base::InputError when the address cannot be sent to.
class UdpSender {
public:
    UdpSender(const std::string& host, std::uint16_t port);
    /// Nobody listening there is no error.
    void send(std::span<const std::uint8_t> datagram);

private:
    boost::asio::io_context io_;
    boost::asio::ip::udp::endpoint to_;
    boost::asio::ip::udp::socket socket_{io_};
};

}  // namespace tracking
