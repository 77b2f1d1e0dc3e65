// SPDX-License-Identifier: Apache-2.0
// The master's end of the link: connecting, ending and trying again.
#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/connect.hpp>
#include <utility>

#include "haptic_bridge/client/connection_thread.hpp"
#include "host/clock.hpp"

namespace haptic_bridge {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

namespace {

constexpr std::chrono::milliseconds kConnectTimeout{3000};
constexpr std::int64_t kLastingNs = 1'000'000'000;  // [ns]

}  // namespace

void Client::Session::connect() {
    if (stopping_) {  // the retry was already due when stop() cancelled it
        return;
    }
    // The first of the two answers below wins. The other finds `done` set.
    const auto done = std::make_shared<bool>(false);
    const auto socket = std::make_shared<tcp::socket>(io_);
    watchTimer_.expires_after(kConnectTimeout);
    watchTimer_.async_wait([this, done, socket](error_code error) {
        if (!error && !std::exchange(*done, true)) {
            error_code ignored;
            socket->close(ignored);
            failed("no reply within 3 s");
        }
    });
    const auto settle = [this, done](error_code error) {
        if (stopping_ || std::exchange(*done, true)) {
            return false;
        }
        watchTimer_.cancel();
        if (error) {
            failed(error.message());
        }
        return !error;
    };
    resolver_.async_resolve(address_.host, std::to_string(address_.port),
                            [this, done, socket, settle](error_code error, const tcp::resolver::results_type& results) {
                                if (error || *done) {
                                    settle(error);
                                    return;
                                }
                                asio::async_connect(*socket, results,
                                                    [this, socket, settle](error_code failure, const tcp::endpoint&) {
                                                        if (settle(failure)) {
                                                            connected(std::move(*socket));
                                                        }
                                                    });
                            });
}

void Client::Session::connected(Connection::Socket socket) {
    connection_ = std::make_shared<Connection>(std::move(socket), security_.tls ? security_.tls->open() : nullptr);
    peer_ = "haptic server " + address_.text();
    handshake_.reset();
    connection_->limit(kMaxGreeting);
    heardNs_ = now_();
    silentUntil_ = {};
    pings_ = 0;
    started_ = false;
    shelf.dropTests();
    watch();
    connection_->start({[this](Message&& message) { receive(std::move(message)); },
                        [this](const std::string& why, Connection::Fault fault) {
                            fault ? refuse("closed, " + why, fault) : closed(why);
                        },
                        false, [this] { greet(); }});
}

void Client::Session::failed(const std::string& why) {
    shelf.fail(fmt::format("no answer ({})", why));
    shelf.tell(everWelcomed_ ? Link::lost : Link::connecting,
               fmt::format("haptic server {} does not answer ({}); trying again", address_.text(), why));
    retry();
}

void Client::Session::closed(const std::string& why) {
    const Link before = shelf.link();
    if (stopping_) {
        io_.stop();
        return;
    }
    if (isUp(before)) {
        // A server that ends each link at once is asked as rarely as one that does not answer.
        const bool began = before == Link::linked || before == Link::streaming;
        const bool lasted = began && host::monotonicNs() - linkedNs_ >= kLastingNs;
        backOff_ = lasted ? kFirstBackOff : backOff_;
        shelf.tell(Link::lost, fmt::format("{}: link lost, {}; trying again", peer_, why));
    } else if (before != Link::refused) {
        failed(why);
        return;
    }
    retry();
}

void Client::Session::countRefusal(RefusalCode code) {
    shelf.count([code](LinkCounters& counters) { ++counters.refused[static_cast<std::size_t>(code) - 1]; });
}

void Client::Session::refuse(const std::string& why, Connection::Fault fault) {
    shelf.fail(why);
    if (fault) {
        countRefusal(*fault);
    }
    shelf.tell(Link::refused, fmt::format("{}: {}", peer_, why));
    backOff_ = kLastBackOff;
    if (stopping_) {
        io_.stop();
        return;
    }
    retry();
}

void Client::Session::retry() {
    if (connection_) {
        const auto gone = std::exchange(connection_, nullptr);
        gone->finish();
    }
    pingTimer_.cancel();
    watchTimer_.cancel();
    if (stopping_) {
        return;
    }
    retryTimer_.expires_after(backOff_);
    backOff_ = std::min(backOff_ * 2, kLastBackOff);
    retryTimer_.async_wait([this](error_code error) {
        if (!error) {
            connect();
        }
    });
}

}  // namespace haptic_bridge
