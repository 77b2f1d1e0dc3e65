// SPDX-License-Identifier: Apache-2.0
#include "tests/hostile/attack.hpp"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <memory>
#include <system_error>

namespace hostile {

using namespace haptic_bridge;

namespace {

constexpr int kPerConnection = 8;
constexpr std::uint64_t kPerFlood = 20'000;

class Socket {
public:
    explicit Socket(int descriptor) : descriptor_(descriptor) {
        const timeval forAnswer{.tv_sec = 0, .tv_usec = 200'000}, forRoom{.tv_sec = 2, .tv_usec = 0};
        setsockopt(descriptor_, SOL_SOCKET, SO_RCVTIMEO, &forAnswer, sizeof forAnswer);
        setsockopt(descriptor_, SOL_SOCKET, SO_SNDTIMEO, &forRoom, sizeof forRoom);
    }
    ~Socket() { close(descriptor_); }
    Socket(const Socket&) = delete;
    Socket& operator=(const Socket&) = delete;

    [[nodiscard]] bool connect(std::uint32_t from, std::uint16_t port) const {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(from);
        (void)bind(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address);
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        address.sin_port = htons(port);
        return ::connect(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    }
    /// False when the other side has gone.
    [[nodiscard]] bool send(const files::Bytes& bytes, int flags = 0) const {
        return ::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL | flags) ==
               static_cast<ssize_t>(bytes.size());
    }
    [[nodiscard]] bool readsRefusal() const {
        std::array<std::uint8_t, 4096> answer{};
        const ssize_t count = recv(descriptor_, answer.data(), answer.size(), 0);
        return count > 4 && answer[4] == 3;
    }
    /// Takes whatever is there, and waits for nothing.
    void drain() const {
        std::array<std::uint8_t, 4096> answer{};
        while (recv(descriptor_, answer.data(), answer.size(), MSG_DONTWAIT) > 0) {
        }
    }

private:
    int descriptor_;
};

int newSocket() { return socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0); }

/// A connection that sends a byte whenever it is asked, and begins anew when it has been cut off.
class Drip {
public:
    Drip(std::uint16_t port, std::uint32_t from, files::Bytes bytes)
        : port_(port), from_(from), bytes_(std::move(bytes)) {}
    void drip() {
        if (!socket_) {
            socket_ = std::make_unique<Socket>(newSocket());
            sent_ = 0;
            if (!socket_->connect(from_, port_)) {
                socket_ = nullptr;
                return;
            }
        }
        if (!socket_->send({bytes_[sent_++ % bytes_.size()]}, MSG_DONTWAIT)) {
            socket_ = nullptr;
        }
    }

private:
    std::uint16_t port_;
    std::uint32_t from_;
    files::Bytes bytes_;
    std::size_t sent_ = 0;
    std::unique_ptr<Socket> socket_;
};

}  // namespace

Done attackServer(std::uint16_t port, Frames& frames, std::uint64_t count, const std::function<bool()>& goOn) {
    Done done;
    constexpr std::uint32_t kLoopback = 127U << 24U;
    Drip unknown(port, kLoopback + 2, encode(Hello{frames.identity()}));
    Drip endless(port, kLoopback + 3, files::Bytes{255, 3, 0, 0});
    while (done.frames < count && goOn()) {
        ++done.connections;
        if (done.connections % 64 == 0) {
            unknown.drip();
            endless.drip();
        }
        const Socket socket(newSocket());
        if (!socket.connect(kLoopback + (1U << 16U) + frames.below(1U << 23U), port)) {
            continue;
        }
        files::Bytes bytes;
        if (frames.below(2) == 0) {
            const Role role = frames.below(4) == 0 ? Role::move : Role::watch;
            bytes = encode(Hello{frames.identity(), role, false, false, {}});
        }
        for (int i = 0; i < kPerConnection; ++i, ++done.frames) {
            const files::Bytes one = frames.next();
            bytes.insert(bytes.end(), one.begin(), one.end());
        }
        if (socket.send(bytes) && done.connections % 4 == 0) {
            done.refusals += socket.readsRefusal() ? 1 : 0;
        }
    }
    return done;
}

FalseServer::FalseServer(std::uint32_t seed, Identity identity, std::uint64_t frames)
    : frames_(seed, std::move(identity)), count_(frames), listener_(newSocket()) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    if (bind(listener_, reinterpret_cast<const sockaddr*>(&address), size) != 0 || listen(listener_, 8) != 0 ||
        getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
        throw std::system_error(errno, std::generic_category(), "a false server");
    }
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { serve(); });
}

FalseServer::~FalseServer() {
    stopping_ = true;
    shutdown(listener_, SHUT_RDWR);
    thread_.join();
    close(listener_);
}

void FalseServer::serve() {
    while (!stopping_ && !done()) {
        pollfd waiting{listener_, POLLIN, 0};
        if (poll(&waiting, 1, 100) > 0) {
            const int guest = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
            if (guest >= 0) {
                ++connections_;
                talk(guest);
            }
        }
    }
}

void FalseServer::talk(int guest) {
    const Socket socket(guest);
    if (frames_.below(2) == 0) {
        // Streams: the master takes positions, whatever they say.
        bool heard = socket.send(encode(PositionGreeting{kProtocolVersion, "false"}));
        for (std::uint64_t i = 0; heard && i < kPerFlood && !stopping_ && !done(); i += 100) {
            files::Bytes many;
            for (int j = 0; j < 100; ++j) {
                const files::Bytes one = frames_.position();
                many.insert(many.end(), one.begin(), one.end());
            }
            heard = socket.send(many);
            sent_ += heard ? 100 : 0;
            socket.drain();
        }
    } else if (frames_.below(2) == 0) {
        Identity other = frames_.identity();
        other.rulesDigest ^= 1;
        (void)socket.send(encode(Welcome{frames_.below(2) == 0 ? other : frames_.identity(), 60, Role::watch, {}}));
    }
    for (int i = 0; i < kPerConnection && socket.send(frames_.next()); ++i) {
        ++sent_;
    }
}

}  // namespace hostile
