// SPDX-License-Identifier: Apache-2.0
#include "tracking/udp_socket.hpp"

#include <fmt/format.h>
#include <linux/filter.h>
#include <linux/sock_diag.h>
#include <sys/socket.h>

#include <array>
#include <boost/asio/buffer.hpp>

#include "base/byte_stream.hpp"
#include "base/input_error.hpp"

namespace tracking {

namespace asio = boost::asio;
using boost::system::error_code;

namespace {

constexpr std::size_t kLargestDatagram = 65536;  // a datagram of UDP is a little smaller, so none is cut off
constexpr int kMostStrangers = 64;               // most datagrams from other addresses that one call skips

asio::ip::address plain(const asio::ip::address& address) {
    return address.is_v6() && address.to_v6().is_v4_mapped()
               ? asio::ip::address(asio::ip::make_address_v4(asio::ip::v4_mapped, address.to_v6()))
               : address;
}

/// Makes the kernel drop datagrams from other addresses, before they use room in the socket's buffer. If the kernel
/// cannot, next() drops them.
void filter(int socket, const asio::ip::address& from) {
    // Compares the source address in the header, word by word. A word that differs drops the datagram.
    const base::Bytes words = [&] {
        if (from.is_v4()) {
            const auto bytes = from.to_v4().to_bytes();
            return base::Bytes(bytes.begin(), bytes.end());
        }
        const auto bytes = from.to_v6().to_bytes();
        return base::Bytes(bytes.begin(), bytes.end());
    }();
    const auto first = static_cast<std::uint32_t>(SKF_NET_OFF) + (from.is_v4() ? 12U : 8U);
    std::vector<sock_filter> program;
    for (std::size_t i = 0; i < words.size(); i += 4) {
        std::uint32_t word = 0;
        for (std::size_t j = i; j < i + 4; ++j) {
            word = word << 8U | words[j];
        }
        program.push_back(BPF_STMT(BPF_LD | BPF_W | BPF_ABS, first + static_cast<std::uint32_t>(i)));
        program.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, word, 1, 0));
        program.push_back(BPF_STMT(BPF_RET | BPF_K, 0));
    }
    program.push_back(BPF_STMT(BPF_RET | BPF_K, ~0U));
    const sock_fprog whole{static_cast<unsigned short>(program.size()), program.data()};
    (void)setsockopt(socket, SOL_SOCKET, SO_ATTACH_FILTER, &whole, sizeof whole);
}

}  // namespace

UdpReceiver::UdpReceiver(const std::string& host, std::uint16_t port, const std::string& from, const std::string& name)
    : buffer_(kLargestDatagram) {
    const asio::ip::udp::endpoint endpoint(asio::ip::make_address(host), port);
    if (!from.empty()) {
        from_ = plain(asio::ip::make_address(from));
    } else if (!endpoint.address().is_loopback()) {
        throw base::InputError(fmt::format(
            "{}: other machines can reach {}; add the tracker's address, such as from=192.168.1.20", name, host));
    }
    error_code error;
    socket_.open(endpoint.protocol(), error);
    native_ = socket_.native_handle();
    if (!error && from_) {
        filter(native_, *from_);
    }
    if (!error) {
        socket_.bind(endpoint, error);
    }
    if (!error) {
        socket_.non_blocking(true, error);
    }
    if (error == asio::error::address_in_use) {
        throw base::InputError(
            fmt::format("{}: port {} is in use; stop the program that has it, or take another port", name, port));
    }
    if (error) {
        throw base::InputError(fmt::format("{}: cannot listen on {} port {}: {}", name, host, port, error.message()));
    }
    port_ = socket_.local_endpoint(error).port();
}

std::optional<std::span<const std::uint8_t>> UdpReceiver::next() {
    for (int i = 0; i < kMostStrangers; ++i) {
        error_code error;
        asio::ip::udp::endpoint from;
        const std::size_t size = socket_.receive_from(asio::buffer(buffer_), from, 0, error);
        if (error) {  // there is no datagram, or an error; in both cases the next frame tries again
            return std::nullopt;
        }
        if (!from_ || plain(from.address()) == *from_) {
            return std::span<const std::uint8_t>(buffer_).first(size);
        }
        ++strangers_;
    }
    return std::nullopt;
}

std::uint64_t UdpReceiver::strangers() const {
    std::array<std::uint32_t, SK_MEMINFO_VARS> info{};
    socklen_t size = sizeof info;
    const bool known = from_ && getsockopt(native_, SOL_SOCKET, SO_MEMINFO, info.data(), &size) == 0;
    return strangers_ + (known ? info[SK_MEMINFO_DROPS] : 0);
}

UdpSender::UdpSender(const std::string& host, std::uint16_t port) : to_(asio::ip::make_address(host), port) {
    error_code error;
    socket_.open(to_.protocol(), error);
    if (error) {
        throw base::InputError(fmt::format("cannot send to {} port {}: {}", host, port, error.message()));
    }
}

void UdpSender::send(std::span<const std::uint8_t> datagram) {
    error_code error;
    socket_.send_to(asio::buffer(datagram.data(), datagram.size()), to_, 0, error);
    if (error && error != asio::error::connection_refused) {
        throw base::InputError(
            fmt::format("cannot send to {} port {}: {}", to_.address().to_string(), to_.port(), error.message()));
    }
}

}  // namespace tracking
