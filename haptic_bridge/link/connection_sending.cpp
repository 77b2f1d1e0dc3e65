// SPDX-License-Identifier: Apache-2.0
// The sending side of a Connection, and its end.
#include <boost/asio/buffer.hpp>
#include <boost/asio/write.hpp>
#include <stdexcept>
#include <utility>

#include "haptic_bridge/link/connection.hpp"

namespace haptic_bridge {

namespace asio = boost::asio;
using boost::system::error_code;

void Connection::sendBytes(base::Bytes bytes) {
    if (!open_ || finishing_) {
        return;
    }
    const bool isLong = bytes.size() > kMaxMessage + sizeof(std::uint32_t);
    if (tls_) {
        base::Bytes sealed;
        try {
            tls_->seal(bytes, sealed);
        } catch (const std::runtime_error& error) {  // the other end may have left a TLS message unfinished
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
    // Shuts down only the sending side. Closing while bytes of the peer are unread would reset the connection. The last
    // message, which gives the reason, would then be lost.
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
