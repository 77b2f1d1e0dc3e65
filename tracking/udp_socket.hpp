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

/// Receiver of the datagrams at a port of this machine. Never waits.
class UdpReceiver {
public:
    /// Opens the port. `host` is an IP address. Datagrams are accepted only from the address `from`, which may be empty
    /// if `host` is loopback. Throws base::InputError that begins with `name` if `from` is empty for another host, or
    /// if the port cannot be opened.
    UdpReceiver(const std::string& host, std::uint16_t port, const std::string& from, const std::string& name);
    /// Returns the next whole datagram, valid until the next call. Returns nullopt if no datagram has arrived, and
    /// after a failure. Skips datagrams from other addresses.
    [[nodiscard]] std::optional<std::span<const std::uint8_t>> next();
    [[nodiscard]] std::uint16_t port() const { return port_; }
    /// Returns the number of datagrams from other addresses, plus the number of datagrams that the kernel dropped for
    /// lack of room.
    [[nodiscard]] std::uint64_t strangers() const;

private:
    boost::asio::io_context io_;
    boost::asio::ip::udp::socket socket_{io_};
    std::optional<boost::asio::ip::address> from_;
    std::uint64_t strangers_ = 0;
    std::vector<std::uint8_t> buffer_;
    std::uint16_t port_ = 0;
    int native_ = -1;  // socket_, for reading its counts
};

/// Sender of datagrams to one address. Throws base::InputError if it cannot send to the address.
class UdpSender {
public:
    UdpSender(const std::string& host, std::uint16_t port);
    /// Sends a datagram. Does not report an error if no program listens there.
    void send(std::span<const std::uint8_t> datagram);

private:
    boost::asio::io_context io_;
    boost::asio::ip::udp::endpoint to_;
    boost::asio::ip::udp::socket socket_{io_};
};

}  // namespace tracking
