// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/connection.hpp"

#include <boost/asio/buffer.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <sstream>
#include <utility>

namespace haptic_bridge {

namespace asio = boost::asio;
using boost::system::error_code;

std::string textOf(const asio::ip::tcp::endpoint& endpoint) {
    std::ostringstream text;
    text << endpoint;
    return text.str();
}

Connection::Connection(Socket socket) : socket_(std::move(socket)), linger_(socket_.get_executor()) {
    error_code ignored;
    // A step must not wait for the acknowledgement of the one before.
    socket_.set_option(asio::ip::tcp::no_delay(true), ignored);
    const auto endpoint = socket_.remote_endpoint(ignored);
    peer_ = ignored ? "an unknown address" : textOf(endpoint);
}

void Connection::start(Handlers handlers) {
    handlers_ = std::move(handlers);
    read();
}

void Connection::read() {
    if (!open_ || reading_ || paused_) {
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
        self->bytesIn_ += count;
        if (!self->finishing_) {
            self->reader_.feed(std::span(self->chunk_).first(count));
            self->deliver();
        }
        self->read();
    });
}

void Connection::deliver() {
    try {
        while (open_ && !paused_ && !finishing_) {
            std::optional<Message> message = reader_.next();
            if (!message) {
                return;
            }
            if (handlers_.message) {
                // A copy: the handler may close the connection, which releases the handlers.
                const auto handle = handlers_.message;
                handle(std::move(*message));
            }
        }
    } catch (const files::FormatError& error) {
        const std::string why = std::string("it sent ") + error.what();
        if (!handlers_.answerGarbage) {
            close(why, true);
            return;
        }
        send(Refusal{RefusalCode::garbage, std::string("this is a Sandwall haptic server; you sent ") + error.what()});
        const auto closed = std::move(handlers_.closed);
        finish();
        closed(why, true);
    }
}

void Connection::resume() {
    if (std::exchange(paused_, false)) {
        deliver();
        read();
    }
}

void Connection::sendBytes(files::Bytes bytes) {
    if (!open_ || finishing_) {
        return;
    }
    unsentBytes_ += bytes.size();
    if (unsentBytes_ > kMaxUnsent) {
        close("it does not read what is sent to it");
        return;
    }
    unsent_.push_back(std::move(bytes));
    if (unsent_.size() == 1) {
        write();
    }
}

void Connection::write() {
    asio::async_write(socket_, asio::buffer(unsent_.front()),
                      [self = shared_from_this()](error_code error, std::size_t count) {
                          if (!self->open_) {
                              return;
                          }
                          if (error) {
                              self->close(error.message());
                              return;
                          }
                          self->bytesOut_ += count;
                          self->unsentBytes_ -= count;
                          self->unsent_.pop_front();
                          if (!self->unsent_.empty()) {
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
    linger_.expires_after(std::chrono::milliseconds(500));
    linger_.async_wait([self = shared_from_this()](error_code) { self->shut(); });
    if (unsent_.empty()) {
        endSending();
    }
    resume();
}

void Connection::endSending() {
    // Only the sending side: closing while the peer's bytes lie unread would reset the connection, and what was sent
    // last, the reason, would be lost on its way.
    error_code ignored;
    socket_.shutdown(Socket::shutdown_send, ignored);
}

void Connection::close(const std::string& why, bool garbage) {
    if (!open_) {
        return;
    }
    const auto closed = std::move(handlers_.closed);
    shut();
    if (closed) {
        closed(why, garbage);
    }
}

void Connection::shut() {
    open_ = false;
    error_code ignored;
    linger_.cancel(ignored);
    socket_.shutdown(Socket::shutdown_both, ignored);
    socket_.close(ignored);
    handlers_ = {};
}

}  // namespace haptic_bridge
