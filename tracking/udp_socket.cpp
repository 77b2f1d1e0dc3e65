// SPDX-License-Identifier: Apache-2.0
#include "tracking/udp_socket.hpp"

#include <fmt/format.h>

#include <boost/asio/buffer.hpp>

#include "files/input_error.hpp"

namespace tracking {

namespace asio = boost::asio;
using boost::system::error_code;

namespace {

constexpr std::size_t kLargestDatagram = 65536;  // UDP has room for a little less, so none is ever cut
constexpr int kMostStrangers = 64;               // that are read over in one call

}  // namespace

UdpReceiver::UdpReceiver(const std::string& host, std::uint16_t port, const std::string& from, const std::string& who)
    : buffer_(kLargestDatagram) {
    const asio::ip::udp::endpoint endpoint(asio::ip::make_address(host), port);
    if (!from.empty()) {
        from_ = asio::ip::make_address(from);
    } else if (!endpoint.address().is_loopback()) {
        throw files::InputError(fmt::format(
            "{}: others can reach {}; name the one tracker's address behind it, such as from=192.168.1.20", who, host));
    }
    error_code error;
    socket_.open(endpoint.protocol(), error);
    if (!error) {
        socket_.bind(endpoint, error);
    }
    if (!error) {
        socket_.non_blocking(true, error);
    }
    if (error == asio::error::address_in_use) {
        throw files::InputError(
            fmt::format("{}: port {} is in use; stop the program that has it, or take another port", who, port));
    }
    if (error) {
        throw files::InputError(fmt::format("{}: cannot listen on {} port {}: {}", who, host, port, error.message()));
    }
    port_ = socket_.local_endpoint(error).port();
}

std::optional<std::span<const std::uint8_t>> UdpReceiver::next() {
    for (int i = 0; i < kMostStrangers; ++i) {
        error_code error;
        asio::ip::udp::endpoint from;
        const std::size_t size = socket_.receive_from(asio::buffer(buffer_), from, 0, error);
        if (error) {  // none is there, or something is wrong: either way the next frame looks again
            return std::nullopt;
        }
        if (!from_ || from.address() == *from_) {
            return std::span<const std::uint8_t>(buffer_).first(size);
        }
        ++strangers_;
    }
    return std::nullopt;
}

UdpSender::UdpSender(const std::string& host, std::uint16_t port) : to_(asio::ip::make_address(host), port) {
    error_code error;
    socket_.open(to_.protocol(), error);
    if (error) {
        throw files::InputError(fmt::format("cannot send to {} port {}: {}", host, port, error.message()));
    }
}

void UdpSender::send(std::span<const std::uint8_t> datagram) {
    error_code error;
    socket_.send_to(asio::buffer(datagram.data(), datagram.size()), to_, 0, error);
    if (error && error != asio::error::connection_refused) {
        throw files::InputError(
            fmt::format("cannot send to {} port {}: {}", to_.address().to_string(), to_.port(), error.message()));
    }
}

}  // namespace tracking
