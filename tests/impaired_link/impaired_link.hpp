// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <thread>

#include "tests/impaired_link/schedule.hpp"

namespace impaired_link {

/// Listens on loopback and hands every connection on to one address, impaired.
///
/// Bytes stay whole and in order. Holds at most kMostHeld bytes a direction, then TCP holds the sender back. Has a
/// thread of its own, which ends with it; connections that still stand are closed.
class ImpairedLink {
public:
    /// Sees all that passes, on the link's thread; `there` when it comes from who has connected.
    using Tap = std::function<void(std::span<const std::uint8_t> bytes, bool there)>;

    /// Throws boost::system::system_error when it cannot listen. Port 0 takes any free one.
    ImpairedLink(const Impairment& impairment, std::string host, std::uint16_t port, std::uint16_t listenPort = 0,
                 Tap tap = {});
    ~ImpairedLink();
    ImpairedLink(const ImpairedLink&) = delete;
    ImpairedLink& operator=(const ImpairedLink&) = delete;

    [[nodiscard]] std::uint16_t port() const { return port_; }

    // Any thread may ask; of all connections so far.
    [[nodiscard]] int connections() const { return connections_; }
    [[nodiscard]] int resets() const { return resets_; }
    [[nodiscard]] std::uint64_t stalls() const { return stalls_; }
    [[nodiscard]] std::size_t mostHeld() const { return mostHeld_; }  // [byte], in one direction

    static constexpr std::size_t kMostHeld = 256 * 1024;  // [byte]

private:
    class Passage;
    void accept();

    const Impairment impairment_;
    const std::string host_;
    const std::uint16_t targetPort_;
    const Tap tap_;
    boost::asio::io_context io_;
    boost::asio::ip::tcp::acceptor acceptor_;
    std::uint16_t port_ = 0;
    std::atomic<int> connections_{0}, resets_{0};
    std::atomic<std::uint64_t> stalls_{0};
    std::atomic<std::size_t> mostHeld_{0};
    std::thread thread_;
};

}  // namespace impaired_link
