// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/link/connection.hpp"

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <new>
#include <sstream>
#include <utility>

#include "host/clock.hpp"

namespace haptic_bridge {

namespace asio = boost::asio;
using boost::system::error_code;

namespace {

constexpr std::chrono::milliseconds kThrottle{20};
// Types with which every TLS record begins: change of cipher, alert, handshake, data. A client's first record is a
// handshake.
constexpr std::uint8_t kFirstRecord = 20, kHandshake = 22, kLastRecord = 23;
constexpr double kRecordBytes = 32;  // [byte], approximate overhead of TLS per message

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
    // A step must not wait for the acknowledgement of the step before.
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
        const auto ready = handlers_.ready;  // a copy, because closing releases the handlers
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
        close("its greeting is too long", RefusalCode::limit);
        return;
    }
    try {
        if (!tls_) {
            reader_.feed(bytes);
        } else if (const auto plain = unseal(bytes)) {
            reader_.feed(*plain);
        } else {
            return;
        }
    } catch (const std::bad_alloc&) {
        refuseGarbage("a message for which this machine has no memory");
        return;
    }
    deliver();
}

/// Returns the decrypted bytes, and sends the answers of TLS. Returns nullopt if this has closed the connection.
std::optional<base::Bytes> Connection::unseal(ByteSpan bytes) {
    base::Bytes plain, reply;
    std::string trouble;
    bool first = false;
    try {
        tls_->receive(bytes, plain, reply);
        // Only once, because a handshake message that arrives in pieces makes the handshake look unfinished again.
        first = !readyCalled_ && tls_->established();
        if (first) {
            readyCalled_ = true;
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
    if (readyCalled_ && plain.size() < bytes.size()) {  // records without a message also cost time
        rate_.use(static_cast<double>(bytes.size() - plain.size()) / kRecordBytes);
    }
    return plain;
}

/// Returns whether the first byte shows that only one side uses TLS. This end then sends the reason and closes.
bool Connection::speaksOtherwise(ByteSpan first) {
    const bool version = first.size() < 2 || first[1] == 3;
    const bool isTls = version && (tls_ && !handlers_.server ? first[0] >= kFirstRecord && first[0] <= kLastRecord
                                                             : first[0] == kHandshake);
    if (isTls == (tls_ != nullptr)) {
        return false;
    }
    if (tls_ && !handlers_.server) {
        close("it does not use TLS; start it with --tls, or start this side without", RefusalCode::tls);
    } else if (tls_) {
        tls_ = nullptr;  // the other side must be able to read the answer
        refuse(RefusalCode::tls, "this server accepts only TLS; give your side --tls and --secret-file",
               "it does not use TLS");
    } else if (handlers_.server) {
        refuse(RefusalCode::tls, "this server does not use TLS; start it with --tls, or start your side without",
               "it uses TLS and this server does not; give --tls to both or to neither");
    } else {
        close("it uses TLS; give this side --tls, too", RefusalCode::tls);
    }
    return true;
}

void Connection::refuse(RefusalCode code, const std::string& answer, const std::string& why) {
    send(Refusal{code, answer});
    const auto closed = std::move(handlers_.closed);
    finish();
    if (closed) {  // otherwise the answer was too long for a peer that does not read, and `closed` was called
        closed(why, code);
    }
}

/// Returns whether the next message may be delivered. If not, delivery continues after kThrottle.
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
                // A copy, because the handler may close the connection, which releases the handlers.
                const auto handle = handlers_.message;
                handle(std::move(*message));
            }
        }
    } catch (const base::FormatError& error) {
        refuseGarbage(error.what());
    } catch (const std::bad_alloc&) {
        refuseGarbage("a message for which this machine has no memory");
    }
}

/// Ends the connection because of `what` the other side has sent.
void Connection::refuseGarbage(const std::string& what) {
    if (handlers_.server) {
        refuse(RefusalCode::garbage, "this is a Sandwall haptic server; you sent " + what, "it sent " + what);
    } else {
        close("it sent " + what, RefusalCode::garbage);
    }
}

void Connection::resume() {
    if (std::exchange(paused_, false)) {
        deliver();
        read();
    }
}

}  // namespace haptic_bridge
