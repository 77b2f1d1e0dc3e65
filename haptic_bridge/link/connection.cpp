// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/link/connection.hpp"

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <boost/asio/write.hpp>
#include <sstream>
#include <utility>

#include "host/clock.hpp"

namespace haptic_bridge {

namespace asio = boost::asio;
using boost::system::error_code;

namespace {

constexpr std::chrono::milliseconds kThrottle{20};
// What TLS begins every record with: change of cipher, alert, handshake, data; a client's first is a handshake.
constexpr std::uint8_t kFirstRecord = 20, kHandshake = 22, kLastRecord = 23;
constexpr double kRecordBytes = 32;  // of TLS around a message, about

}  // namespace

std::string textOf(const asio::ip::tcp::endpoint& endpoint) {
    std::ostringstream text;
    text << endpoint;
    return text.str();
}

Connection::Connection(Socket socket, std::unique_ptr<TlsSession> tls)
    : socket_(std::move(socket)),
      tls_(std::move(tls)),
      linger_(socket_.get_executor()),
      throttle_(socket_.get_executor()),
      rate_(kMaxRate, host::monotonicNs()) {
    error_code ignored;
    // A step must not wait for the acknowledgement of the one before.
    socket_.set_option(asio::ip::tcp::no_delay(true), ignored);
    const auto endpoint = socket_.remote_endpoint(ignored);
    peer_ = ignored ? "an unknown address" : textOf(endpoint);
    address_ = endpoint.address();
}

void Connection::start(Handlers handlers) {
    handlers_ = std::move(handlers);
    if (tls_ && !handlers_.server) {
        base::Bytes first;
        tls_->begin(first);
        push(std::move(first), false);
    }
    read();
    if (!tls_ && handlers_.ready) {
        const auto ready = handlers_.ready;  // a copy: closing releases the handlers
        ready();
    }
}

void Connection::read() {
    if (!open_ || reading_ || paused_ || throttling_) {
        return;
    }
    reading_ = true;
    socket_.async_read_some(asio::buffer(chunk_), [self = shared_from_this()](error_code error, std::size_t count) {
        self->reading_ = false;
        if (!self->open_) {
            return;
        }
        if (error) {
            const std::string where = self->reader_.midMessage() ? " in the middle of a message" : "";
            self->close((error == asio::error::eof ? "the connection ended" : error.message()) + where);
            return;
        }
        if (!self->finishing_) {
            self->take(count);
        }
        self->bytesIn_ += count;
        self->read();
    });
}

void Connection::take(std::size_t count) {
    const auto bytes = ByteSpan(chunk_).first(count);
    if (bytesIn_ == 0 && speaksOtherwise(bytes)) {
        return;
    }
    if (bytesIn_ + count > maxIn_) {
        close("a greeting too long", RefusalCode::limit);
        return;
    }
    if (!tls_) {
        reader_.feed(bytes);
    } else if (const auto plain = unseal(bytes)) {
        reader_.feed(*plain);
    } else {
        return;
    }
    deliver();
}

/// Returns the bytes that TLS has carried, and answers TLS. Returns nullopt if that has closed the connection.
std::optional<base::Bytes> Connection::unseal(ByteSpan bytes) {
    base::Bytes plain, reply;
    std::string trouble;
    bool first = false;
    try {
        tls_->receive(bytes, plain, reply);
        // Once: a message of the handshake that comes in pieces makes it look unfinished again.
        first = !told_ && tls_->established();
        if (first) {
            told_ = true;
            binding_ = tls_->binding();
        }
    } catch (const std::runtime_error& error) {
        trouble = error.what();
    }
    if (!reply.empty()) {
        push(std::move(reply), false);
    }
    if (!trouble.empty()) {
        close("TLS failed: " + trouble, RefusalCode::tls);
        return std::nullopt;
    }
    if (first && open_ && handlers_.ready) {
        const auto ready = handlers_.ready;
        ready();
    }
    if (told_ && plain.size() < bytes.size()) {  // records that never become a message cost time, too
        rate_.use(static_cast<double>(bytes.size() - plain.size()) / kRecordBytes);
    }
    return plain;
}

/// Whether the first byte tells that one side speaks TLS and the other does not; this end then says so and closes.
bool Connection::speaksOtherwise(ByteSpan first) {
    const bool version = first.size() < 2 || first[1] == 3;
    const bool isTls = version && (tls_ && !handlers_.server ? first[0] >= kFirstRecord && first[0] <= kLastRecord
                                                             : first[0] == kHandshake);
    if (isTls == (tls_ != nullptr)) {
        return false;
    }
    if (tls_ && !handlers_.server) {
        close("it does not speak TLS; start it with --tls, or this side without", RefusalCode::tls);
    } else if (tls_) {
        tls_ = nullptr;  // the answer must be understood
        refuse(RefusalCode::tls, "this server speaks TLS alone; give your side --tls and --secret-file",
               "it does not speak TLS");
    } else if (handlers_.server) {
        refuse(RefusalCode::tls, "this server speaks no TLS; start it with --tls, or your side without",
               "it speaks TLS, this server does not; both take --tls or neither");
    } else {
        close("it speaks TLS; give this side --tls, too", RefusalCode::tls);
    }
    return true;
}

void Connection::refuse(RefusalCode code, const std::string& answer, const std::string& why) {
    send(Refusal{code, answer});
    const auto closed = std::move(handlers_.closed);
    finish();
    if (closed) {  // unless the answer was too much for who does not read: then it has been called
        closed(why, code);
    }
}

/// Counts the message that comes next; false when it must wait.
bool Connection::mayDeliver() {
    if (rate_.allows(host::monotonicNs)) {
        return true;
    }
    ++throttles_;
    throttling_ = true;
    throttle_.expires_after(kThrottle);
    throttle_.async_wait([self = shared_from_this()](error_code error) {
        if (!error && self->open_) {
            self->throttling_ = false;
            self->deliver();
            self->read();
        }
    });
    return false;
}

void Connection::deliver() {
    try {
        while (open_ && !paused_ && !throttling_ && !finishing_) {
            if (!mayDeliver()) {
                return;
            }
            std::optional<Message> message = reader_.next();
            if (!message) {
                return;
            }
            rate_.use(1);
            if (handlers_.message) {
                // A copy: the handler may close the connection, which releases the handlers.
                const auto handle = handlers_.message;
                handle(std::move(*message));
            }
        }
    } catch (const base::FormatError& error) {
        const std::string why = std::string("it sent ") + error.what();
        if (!handlers_.server) {
            close(why, RefusalCode::garbage);
            return;
        }
        refuse(RefusalCode::garbage, std::string("this is a Sandwall haptic server; you sent ") + error.what(), why);
    }
}

void Connection::resume() {
    if (std::exchange(paused_, false)) {
        deliver();
        read();
    }
}

void Connection::sendBytes(base::Bytes bytes) {
    if (!open_ || finishing_) {
        return;
    }
    const bool isLong = bytes.size() > kMaxMessage + sizeof(std::uint32_t);
    if (tls_) {
        base::Bytes sealed;
        try {
            tls_->seal(bytes, sealed);
        } catch (const std::runtime_error& error) {  // the other end may have begun what it does not finish
            close(std::string("TLS failed: ") + error.what(), RefusalCode::tls);
            return;
        }
        bytes = std::move(sealed);
    }
    push(std::move(bytes), isLong);
}

void Connection::push(base::Bytes bytes, bool isLong) {
    if (!outbox_.push(std::move(bytes), isLong)) {
        close("it does not read what is sent to it", RefusalCode::limit);
    } else if (outbox_.size() == 1) {
        write();
    }
}

void Connection::write() {
    asio::async_write(socket_, asio::buffer(outbox_.front()),
                      [self = shared_from_this()](error_code error, std::size_t count) {
                          if (!self->open_) {
                              return;
                          }
                          if (error) {
                              self->close(error.message());
                              return;
                          }
                          self->bytesOut_ += count;
                          self->outbox_.pop();
                          if (!self->outbox_.empty()) {
                              self->write();
                          } else if (self->finishing_) {
                              self->endSending();
                          }
                      });
}

void Connection::finish() {
    if (!open_ || finishing_) {
        return;
    }
    finishing_ = true;
    handlers_ = {};
    linger_.expires_after(lingers_);
    linger_.async_wait([self = shared_from_this()](error_code) { self->shut(); });
    if (outbox_.empty()) {
        endSending();
    }
    throttling_ = false;
    resume();
    read();
}

void Connection::endSending() {
    // Only the sending side: closing while the peer's bytes lie unread would reset the connection, and what was sent
    // last, the reason, would be lost on its way.
    error_code ignored;
    socket_.shutdown(Socket::shutdown_send, ignored);
}

void Connection::close(const std::string& why, Fault fault) {
    if (!open_) {
        return;
    }
    const auto closed = std::move(handlers_.closed);
    shut();
    if (closed) {
        closed(why, fault);
    }
}

void Connection::shut() {
    open_ = false;
    error_code ignored;
    linger_.cancel(ignored);
    throttle_.cancel(ignored);
    socket_.shutdown(Socket::shutdown_both, ignored);
    socket_.close(ignored);
    handlers_ = {};
}

}  // namespace haptic_bridge
