// SPDX-License-Identifier: Apache-2.0
#include "tests/impaired_link/impaired_link.hpp"

#include <algorithm>
#include <array>
#include <boost/asio/connect.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <deque>
#include <memory>
#include <utility>
#include <vector>

#include "host/clock.hpp"

namespace impaired_link {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

/// A connection and the connection to its target. Used only on the link's thread.
class ImpairedLink::Passage : public std::enable_shared_from_this<Passage> {
public:
    Passage(ImpairedLink& link, tcp::socket client, std::uint32_t number)
        : link_(link),
          client_(std::move(client)),
          host_(link.io_),
          resolver_(link.io_),
          there_(link, client_, host_, 2 * number),
          back_(link, host_, client_, 2 * number + 1) {}

    void open() {
        resolver_.async_resolve(
            link_.host_, std::to_string(link_.targetPort_),
            [self = shared_from_this()](error_code error, const tcp::resolver::results_type& results) {
                if (error) {
                    self->close();
                    return;
                }
                asio::async_connect(self->host_, results, [self](error_code failure, const tcp::endpoint&) {
                    if (failure) {
                        self->close();
                        return;
                    }
                    error_code ignored;
                    self->client_.set_option(tcp::no_delay(true), ignored);
                    self->host_.set_option(tcp::no_delay(true), ignored);
                    self->read(self->there_);
                    self->read(self->back_);
                });
            });
    }

private:
    struct Piece {
        std::vector<std::uint8_t> bytes;  // empty at the end of the stream
        std::int64_t leavesNs = 0;
    };
    /// One direction of a connection.
    struct Way {
        Way(ImpairedLink& link, tcp::socket& source, tcp::socket& sink, std::uint32_t stream)
            : from(source), to(sink), schedule(link.impairment_, stream), timer(link.io_) {}
        tcp::socket& from;
        tcp::socket& to;
        Schedule schedule;
        asio::steady_timer timer;
        std::deque<Piece> pieces;
        std::size_t held = 0;  // [byte]
        std::array<std::uint8_t, kPiece> chunk{};
        bool reading = false, ended = false;
    };

    void read(Way& way) {
        if (way.reading || way.ended || way.held + kPiece > kMostHeld) {
            return;
        }
        way.reading = true;
        way.from.async_read_some(asio::buffer(way.chunk),
                                 [self = shared_from_this(), &way](error_code error, std::size_t count) {
                                     way.reading = false;
                                     if (error && error != asio::error::eof) {
                                         self->close();
                                         return;
                                     }
                                     self->take(way, count);
                                 });
    }

    void take(Way& way, std::size_t count) {
        way.ended = count == 0;
        if (link_.tap_) {
            link_.tap_(std::span<const std::uint8_t>(way.chunk).first(count), &way == &there_);
        }
        bytes_ += count;
        const Impairment& impairment = link_.impairment_;
        if (impairment.resetAfter > 0 && bytes_ >= impairment.resetAfter && link_.resets_ < impairment.resets) {
            ++link_.resets_;
            reset();
            return;
        }
        const std::uint64_t stalls = way.schedule.stalls();
        const auto end = way.chunk.begin() + static_cast<std::ptrdiff_t>(count);
        way.pieces.push_back({{way.chunk.begin(), end}, way.schedule.leaves(host::monotonicNs())});
        link_.stalls_ += way.schedule.stalls() - stalls;
        way.held += count;
        link_.mostHeld_ = std::max(link_.mostHeld_.load(), way.held);
        if (way.pieces.size() == 1) {
            pass(way);
        }
        read(way);
    }

    void pass(Way& way) {
        way.timer.expires_at(
            std::chrono::steady_clock::time_point(std::chrono::nanoseconds(way.pieces.front().leavesNs)));
        way.timer.async_wait([self = shared_from_this(), &way](error_code cancelled) {
            if (cancelled) {
                return;
            }
            const std::vector<std::uint8_t>& bytes = way.pieces.front().bytes;
            if (bytes.empty()) {
                error_code ignored;
                way.to.shutdown(tcp::socket::shutdown_send, ignored);
                return;
            }
            asio::async_write(way.to, asio::buffer(bytes), [self, &way](error_code error, std::size_t count) {
                if (error) {
                    self->close();
                    return;
                }
                way.held -= count;
                way.pieces.pop_front();
                if (!way.pieces.empty()) {
                    self->pass(way);
                }
                self->read(way);
            });
        });
    }

    void reset() {
        error_code ignored;
        // Closing without lingering sends a reset instead of an end.
        client_.set_option(asio::socket_base::linger(true, 0), ignored);
        host_.set_option(asio::socket_base::linger(true, 0), ignored);
        close();
    }

    void close() {
        error_code ignored;
        there_.timer.cancel(ignored);
        back_.timer.cancel(ignored);
        client_.close(ignored);
        host_.close(ignored);
    }

    ImpairedLink& link_;
    tcp::socket client_, host_;
    tcp::resolver resolver_;
    Way there_, back_;
    std::uint64_t bytes_ = 0;
};

ImpairedLink::ImpairedLink(const Impairment& impairment, std::string host, std::uint16_t port, std::uint16_t listenPort,
                           Tap tap)
    : impairment_(impairment),
      host_(std::move(host)),
      targetPort_(port),
      tap_(std::move(tap)),
      acceptor_(io_, tcp::endpoint(asio::ip::address_v4::loopback(), listenPort)) {
    port_ = acceptor_.local_endpoint().port();
    accept();
    thread_ = std::thread([this] { io_.run(); });
}

ImpairedLink::~ImpairedLink() {
    io_.stop();
    thread_.join();
}

void ImpairedLink::accept() {
    acceptor_.async_accept([this](error_code error, tcp::socket client) {
        if (!error) {
            const int number = connections_++;
            std::make_shared<Passage>(*this, std::move(client), static_cast<std::uint32_t>(number))->open();
        }
        accept();
    });
}

}  // namespace impaired_link
