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

/// One TCP connection that carries messages, in plain text or over TLS.
///
/// Threads: all calls and callbacks are on the one thread of the connection's executor.
///
/// The connection releases its callbacks when it has closed, so that a callback may own the owner of the connection. If
/// the other side sends more messages than setRate() allows, the connection reads more slowly. For one peer it
/// allocates at most one long message that was expected, and kMaxUnsent bytes.
class Connection : public std::enable_shared_from_this<Connection> {
public:
    using Socket = boost::asio::ip::tcp::socket;
    using Fault = std::optional<RefusalCode>;  // fault of the other side; nullopt if it made none
    struct Handlers {
        std::function<void(Message&&)> message;
        /// Called once when the connection has ended, with the reason.
        std::function<void(const std::string& why, Fault fault)> closed;
        bool server = false;  // true: this end answers garbage with a Refusal before it closes
        /// Called when messages may be sent. Without TLS, start() calls it before it returns.
        std::function<void()> ready = {};
    };

    /// If `tls` is not null, it encrypts all bytes.
    explicit Connection(Socket socket, std::unique_ptr<TlsSession> tls = nullptr);
    void start(Handlers handlers);

    void send(const Message& message) { sendBytes(encode(message)); }
    /// Sends `bytes`, an encoded message. Closes the connection if the other side leaves too much unread: more than
    /// setMaxUnsent() bytes in ordinary messages, or a second long message.
    void sendBytes(base::Bytes bytes);
    void expectState(bool expected, std::size_t most = kMaxState) { reader_.expectState(expected, most); }
    void expectLoads(bool expected, std::size_t most = kMaxState) { reader_.expectLoads(expected, most); }
    /// Sets the largest length of an ordinary message from now on [byte].
    void limit(std::size_t most) { reader_.limit(most); }
    /// Sets how many bytes of ordinary messages may wait to be sent; kMaxUnsent at first.
    void setMaxUnsent(std::size_t most) { outbox_.setMost(most); }
    /// Sets how many messages are read per second at most, and in one burst; kMaxRate at first.
    void setRate(double perSecond) { rate_.setRate(perSecond); }
    /// Sets the largest number of bytes that may arrive in total; unlimited at first. A peer that sends more is
    /// disconnected.
    void setMaxIn(std::uint64_t most) { maxIn_ = most; }
    /// Sets how long finish() waits for the other side at most; half a second at first.
    void setLinger(std::chrono::milliseconds most) { lingers_ = most; }
    /// Stops reading after the current message, until resume(). TCP then holds the other side back.
    void pause() { paused_ = true; }
    void resume();
    /// Closes at once. Calls `closed` with `why`, unless it was called before.
    void close(const std::string& why, Fault fault = std::nullopt);
    /// Closes when everything that was sent has arrived, or after the time of setLinger(). Does not call `closed`.
    void finish();

    [[nodiscard]] std::uint64_t bytesIn() const { return bytesIn_; }
    [[nodiscard]] std::uint64_t bytesOut() const { return bytesOut_; }
    [[nodiscard]] std::uint64_t throttled() const { return throttles_; }  // times at which reading was slowed down
    [[nodiscard]] std::string peer() const { return peer_; }              // such as "127.0.0.1:40312"
    [[nodiscard]] boost::asio::ip::address address() const { return address_; }
    [[nodiscard]] bool overTls() const { return tls_ != nullptr; }
    /// Returns TlsSession::binding() at the call of `ready`; empty without TLS.
    [[nodiscard]] const base::Bytes& binding() const { return binding_; }

    static constexpr std::size_t kMaxUnsent = 1024 * 1024;  // [byte] of ordinary messages
    static constexpr double kMaxRate = 50'000;  // [message/s]; a device that streams positions sends up to 16000
    static constexpr std::chrono::milliseconds kLinger{500};

private:
    void read();
    void take(std::size_t count);
    [[nodiscard]] std::optional<base::Bytes> unseal(ByteSpan bytes);
    [[nodiscard]] bool speaksOtherwise(ByteSpan first);
    void refuse(RefusalCode code, const std::string& answer, const std::string& why);
    void refuseGarbage(const std::string& what);
    void deliver();
    [[nodiscard]] bool mayDeliver();
    void push(base::Bytes bytes, bool isLong);
    void write();
    void endSending();
    void shut();

    Socket socket_;
    std::unique_ptr<TlsSession> tls_;
    base::Bytes binding_;
    bool readyCalled_ = false;  // whether `ready` was called after the TLS handshake
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

/// Returns a text such as "127.0.0.1:7750" or "[::1]:7750".
[[nodiscard]] std::string textOf(const boost::asio::ip::tcp::endpoint& endpoint);

}  // namespace haptic_bridge
