// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>

#include "haptic_bridge/link/handshake.hpp"
#include "haptic_bridge/server/listener.hpp"

namespace haptic_bridge {

/// Answers peers with Loading while the main thread reads the scene. It runs the io context on a thread of its own
/// until end(). Connections that are open then close in the io context's next run, so this object must outlive that.
class LoadingAnswers {
public:
    /// Takes over `acceptor`, which must listen. `log` prints one line for the user; any thread calls it.
    LoadingAnswers(boost::asio::io_context& io, boost::asio::ip::tcp::acceptor acceptor, const LinkSecurity& security,
                   std::function<void(const std::string&)> log);
    ~LoadingAnswers();
    LoadingAnswers(const LoadingAnswers&) = delete;
    LoadingAnswers& operator=(const LoadingAnswers&) = delete;

    /// Sets the part of the work that is done, 0 to 1. It never goes back.
    void setDone(double share);
    /// Says goodbye to all peers, and returns the acceptor.
    [[nodiscard]] boost::asio::ip::tcp::acceptor end();

private:
    boost::asio::io_context& io_;
    std::atomic<std::uint32_t> done_{0};  // of Loading::kAll
    Listener listener_;
    std::thread thread_;
};

}  // namespace haptic_bridge
