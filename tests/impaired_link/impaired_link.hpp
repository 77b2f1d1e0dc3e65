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

/// A link that listens on loopback and forwards every connection to one address, impaired.
///
/// Bytes stay whole and in order. Each direction holds at most kMostHeld bytes; then TCP holds the sender back. The
/// link has a thread of its own. The destructor ends the thread and closes open connections.
class ImpairedLink {
public:
    /// Gets all bytes that pass, on the link's thread. `there` is true for bytes from the side that has connected.
    using Tap = std::function<void(std::span<const std::uint8_t> bytes, bool there)>;

    /// Listens on `listenPort`; 0 selects a free port. Throws boost::system::system_error if it cannot listen.
    ImpairedLink(const Impairment& impairment, std::string host, std::uint16_t port, std::uint16_t listenPort = 0,
                 Tap tap = {});
    ~ImpairedLink();
    ImpairedLink(const ImpairedLink&) = delete;
    ImpairedLink& operator=(const ImpairedLink&) = delete;

    [[nodiscard]] std::uint16_t port() const { return port_; }

    // Any thread may call these. They count all connections so far.
    [[nodiscard]] int connections() const { return connections_; }
    [[nodiscard]] int resets() const { return resets_; }
    [[nodiscard]] std::uint64_t stalls() const { return stalls_; }
    [[nodiscard]] std::size_t mostHeld() const { return mostHeld_; }  // [byte], the most held in one direction

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
