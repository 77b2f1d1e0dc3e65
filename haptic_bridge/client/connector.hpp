// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <functional>
#include <memory>
#include <string>

#include "haptic_bridge/link/address.hpp"

namespace haptic_bridge {

/// Connects to an address, one attempt at a time. Used by one thread.
class Connector {
public:
    using Socket = boost::asio::ip::tcp::socket;
    struct Answers {
        std::function<void(Socket socket)> connected;
        std::function<void(const std::string& why)> failed;
    };

    explicit Connector(boost::asio::io_context& io) : resolver_(io), limit_(io) {}

    /// Calls one of `answers`, within 3 s, unless cancel() comes first.
    void connect(const Address& address, Answers answers);
    /// Ends an attempt without an answer.
    void cancel();

private:
    struct Attempt;
    void end(const std::string& why);

    boost::asio::ip::tcp::resolver resolver_;
    boost::asio::steady_timer limit_;   // of an attempt
    std::shared_ptr<Attempt> attempt_;  // null: none is under way
};

}  // namespace haptic_bridge
