// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>

#include "haptic_bridge/protocol.hpp"

namespace haptic_bridge {

/// One TCP connection that carries messages. Lives on its executor's one thread: every call and callback is there.
///
/// Both callbacks are released when the connection has closed, so that they may hold what owns the connection.
class Connection : public std::enable_shared_from_this<Connection> {
public:
    using Socket = boost::asio::ip::tcp::socket;
    struct Handlers {
        std::function<void(Message&&)> message;
        /// Once: why the connection ended, in words. `garbage` when the other side sent what is no message.
        std::function<void(const std::string& why, bool garbage)> closed;
        bool answerGarbage = false;  // with a Refusal, before closing
    };

    explicit Connection(Socket socket);
    void start(Handlers handlers);

    void send(const Message& message) { sendBytes(encode(message)); }
    /// Closes the connection when the other side leaves more than kMaxUnsent bytes unread.
    void sendBytes(files::Bytes bytes);
    void expectState(bool expected) { reader_.expectState(expected); }
    void expectLoads(bool expected) { reader_.expectLoads(expected); }
    /// Reading stops after the message in hand, and goes on with resume(): TCP then holds the other side back.
    void pause() { paused_ = true; }
    void resume();
    /// Closes at once; `closed` is called with `why`, unless it was before.
    void close(const std::string& why, bool garbage = false);
    /// Closes when everything sent has arrived, or after half a second; `closed` is not called any more.
    void finish();

    [[nodiscard]] std::uint64_t bytesIn() const { return bytesIn_; }
    [[nodiscard]] std::uint64_t bytesOut() const { return bytesOut_; }
    [[nodiscard]] std::string peer() const { return peer_; }  // "127.0.0.1:40312"

    static constexpr std::size_t kMaxUnsent = 2 * kMaxState;

private:
    void read();
    void deliver();
    void write();
    void endSending();
    void shut();

    Socket socket_;
    boost::asio::steady_timer linger_;
    Handlers handlers_;
    MessageReader reader_;
    std::array<std::uint8_t, 64 * 1024> chunk_{};
    std::deque<files::Bytes> unsent_;
    std::size_t unsentBytes_ = 0;
    std::uint64_t bytesIn_ = 0, bytesOut_ = 0;
    std::string peer_;
    bool paused_ = false, reading_ = false, finishing_ = false, open_ = true;
};

/// "127.0.0.1:7750", or "[::1]:7750".
[[nodiscard]] std::string textOf(const boost::asio::ip::tcp::endpoint& endpoint);

}  // namespace haptic_bridge
