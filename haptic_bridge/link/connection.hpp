// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "haptic_bridge/link/message_reader.hpp"
#include "haptic_bridge/link/outbox.hpp"
#include "haptic_bridge/link/protocol.hpp"
#include "haptic_bridge/link/rate_limit.hpp"
#include "haptic_bridge/link/security.hpp"

namespace haptic_bridge {

/// One TCP connection that carries messages, in the clear or over TLS. Lives on its executor's one thread: every call
/// and callback is there.
///
/// Callbacks are released when the connection has closed, so that they may hold what owns the connection. Whoever sends
/// more messages than setRate() allows is read from more slowly; a peer never gets more memory than one long message
/// that was asked for, and kMaxUnsent.
class Connection : public std::enable_shared_from_this<Connection> {
public:
    using Socket = boost::asio::ip::tcp::socket;
    using Fault = std::optional<RefusalCode>;  // what the other side did wrong, if it did
    struct Handlers {
        std::function<void(Message&&)> message;
        /// Once: why the connection ended, in words.
        std::function<void(const std::string& why, Fault fault)> closed;
        bool server = false;  // of two ends the one that answers garbage with a Refusal, before closing
        /// Messages may be sent from now on; before start() returns where there is no TLS to agree on.
        std::function<void()> ready = {};
    };

    /// `tls`, when given, carries everything.
    explicit Connection(Socket socket, std::unique_ptr<TlsSession> tls = nullptr);
    void start(Handlers handlers);

    void send(const Message& message) { sendBytes(encode(message)); }
    /// Closes the connection when the other side leaves too much unread: more than setMaxUnsent() in ordinary messages,
    /// or a second long one.
    void sendBytes(base::Bytes bytes);
    void expectState(bool expected) { reader_.expectState(expected); }
    void expectLoads(bool expected) { reader_.expectLoads(expected); }
    /// Ordinary messages may be so long from now on [byte].
    void limit(std::size_t most) { reader_.limit(most); }
    /// [byte]; kMaxUnsent at first.
    void setMaxUnsent(std::size_t most) { outbox_.setMost(most); }
    /// Messages a second that are read at most, and as many at once; kMaxRate at first.
    void setRate(double perSecond) { rate_.setRate(perSecond); }
    /// [byte] that may come in all, without bound at first: who sends more is cut off.
    void setMaxIn(std::uint64_t most) { maxIn_ = most; }
    /// How long finish() waits for the other side at most; half a second at first.
    void setLinger(std::chrono::milliseconds most) { lingers_ = most; }
    /// Reading stops after the message in hand, and goes on with resume(): TCP then holds the other side back.
    void pause() { paused_ = true; }
    void resume();
    /// Closes at once; `closed` is called with `why`, unless it was before.
    void close(const std::string& why, Fault fault = std::nullopt);
    /// Closes when everything sent has arrived, or after setLinger(); `closed` is not called any more.
    void finish();

    [[nodiscard]] std::uint64_t bytesIn() const { return bytesIn_; }
    [[nodiscard]] std::uint64_t bytesOut() const { return bytesOut_; }
    [[nodiscard]] std::uint64_t throttled() const { return throttles_; }  // how often it was read from more slowly
    [[nodiscard]] std::string peer() const { return peer_; }              // "127.0.0.1:40312"
    [[nodiscard]] boost::asio::ip::address address() const { return address_; }
    [[nodiscard]] bool overTls() const { return tls_ != nullptr; }
    /// TlsSession::binding() as it was when `ready` was called, or nothing.
    [[nodiscard]] const base::Bytes& binding() const { return binding_; }

    static constexpr std::size_t kMaxUnsent = 1024 * 1024;  // [byte], of ordinary messages
    static constexpr double kMaxRate = 50'000;              // [1/s]; a device that streams positions makes 16000
    static constexpr std::chrono::milliseconds kLinger{500};

private:
    void read();
    void take(std::size_t count);
    [[nodiscard]] std::optional<base::Bytes> unseal(ByteSpan bytes);
    [[nodiscard]] bool speaksOtherwise(ByteSpan first);
    void refuse(RefusalCode code, const std::string& answer, const std::string& why);
    void deliver();
    [[nodiscard]] bool mayDeliver();
    void push(base::Bytes bytes, bool isLong);
    void write();
    void endSending();
    void shut();

    Socket socket_;
    std::unique_ptr<TlsSession> tls_;
    base::Bytes binding_;
    bool told_ = false;  // that TLS is established
    boost::asio::steady_timer linger_, throttle_;
    Handlers handlers_;
    MessageReader reader_;
    std::array<std::uint8_t, 64 * 1024> chunk_{};
    Outbox outbox_{kMaxUnsent};
    std::uint64_t maxIn_ = std::numeric_limits<std::uint64_t>::max();  // [byte]
    std::chrono::milliseconds lingers_ = kLinger;
    std::uint64_t bytesIn_ = 0, bytesOut_ = 0, throttles_ = 0;
    RateLimit rate_;
    std::string peer_;
    boost::asio::ip::address address_;
    bool paused_ = false, throttling_ = false, reading_ = false, finishing_ = false, open_ = true;
};

/// "127.0.0.1:7750", or "[::1]:7750".
[[nodiscard]] std::string textOf(const boost::asio::ip::tcp::endpoint& endpoint);

}  // namespace haptic_bridge
