// SPDX-License-Identifier: Apache-2.0
#include "tests/hostile/attack.hpp"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <memory>
#include <mutex>
#include <system_error>
#include <vector>

#include "haptic_bridge/link/message_reader.hpp"

namespace hostile {

using namespace haptic_bridge;

class Socket {
public:
    explicit Socket(int descriptor) : descriptor_(descriptor) {
        const timeval most{.tv_sec = 2, .tv_usec = 0};
        setsockopt(descriptor_, SOL_SOCKET, SO_RCVTIMEO, &most, sizeof most);
        setsockopt(descriptor_, SOL_SOCKET, SO_SNDTIMEO, &most, sizeof most);
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
    /// Sends bytes. Returns false if the other side has closed the connection.
    [[nodiscard]] bool send(const base::Bytes& bytes, int flags = 0) const {
        return ::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL | flags) ==
               static_cast<ssize_t>(bytes.size());
    }
    /// Returns the received bytes, or an empty list if the other side has closed the connection or stays silent.
    [[nodiscard]] base::Bytes receive() const {
        std::array<std::uint8_t, 4096> answer{};
        const ssize_t count = recv(descriptor_, answer.data(), answer.size(), 0);
        return {answer.begin(), answer.begin() + std::max<ssize_t>(count, 0)};
    }
    void endSending() const { shutdown(descriptor_, SHUT_WR); }
    /// Discards the bytes that have arrived, without waiting.
    void drain() const {
        std::array<std::uint8_t, 4096> answer{};
        while (recv(descriptor_, answer.data(), answer.size(), MSG_DONTWAIT) > 0) {
        }
    }

private:
    int descriptor_;
};

namespace {

constexpr int kConnections = 12;  // at once; with more connections the server closes the oldest one
constexpr std::uint64_t kPerFlood = 20'000;
constexpr std::uint32_t kLoopback = 127U << 24U;

int newSocket() { return socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0); }

/// A connection that sends one byte per call. Connects again when the server has closed it.
class Drip {
public:
    Drip(std::uint16_t port, std::uint32_t from, base::Bytes bytes)
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
    base::Bytes bytes_;
    std::size_t sent_ = 0;
    std::unique_ptr<Socket> socket_;
};

}  // namespace

namespace {

/// One frame over a connection of its own, with TLS and a greeting before it where needed.
class Visit {
public:
    Visit(const Socket& socket, const LinkSecurity& security) : socket_(socket), security_(security) {}

    /// Establishes TLS if the link uses it.
    [[nodiscard]] bool agree(bool server = false) {
        if (!security_.tls) {
            return true;
        }
        tls_ = security_.tls->open();
        base::Bytes first;
        if (!server) {
            tls_->begin(first);
        }
        bool open = first.empty() || socket_.send(first);
        while (open && !tls_->established()) {
            open = receive();
        }
        return open;
    }
    /// Greets the server as a watcher. Returns true if the server has sent its welcome.
    [[nodiscard]] bool greet(const Identity& identity) {
        MasterHandshake handshake(security_, identity, Role::watch, tls_ ? tls_->binding() : base::Bytes());
        bool open = send(encode(handshake.hello()));
        while (open) {
            const auto message = reader_.next();
            if (!message) {
                open = receive();
            } else if (const auto* challenge = std::get_if<Challenge>(&*message)) {
                const auto proof = handshake.answer(*challenge);
                open = proof && send(encode(*proof));
            } else {
                return std::holds_alternative<Welcome>(*message);
            }
        }
        return false;
    }
    [[nodiscard]] bool send(const base::Bytes& bytes) {
        if (!tls_) {
            return socket_.send(bytes);
        }
        base::Bytes sealed;
        tls_->seal(bytes, sealed);
        return socket_.send(sealed);
    }
    /// Sends no more, and receives until the other side ends or stays silent.
    void end() {
        socket_.endSending();
        while (receive()) {
        }
    }
    [[nodiscard]] std::uint64_t heard() const { return heard_; }  // [byte], received so far
    [[nodiscard]] bool refused() {
        while (const auto message = reader_.next()) {
            if (std::holds_alternative<Refusal>(*message)) {
                return true;
            }
        }
        return false;
    }

private:
    bool receive() {
        const base::Bytes bytes = socket_.receive();
        heard_ += bytes.size();
        if (!tls_) {
            reader_.feed(bytes);
        } else if (!bytes.empty()) {
            base::Bytes plain, reply;
            tls_->receive(bytes, plain, reply);
            reader_.feed(plain);
            return reply.empty() || socket_.send(reply);
        }
        return !bytes.empty();
    }

    const Socket& socket_;
    const LinkSecurity& security_;
    std::unique_ptr<TlsSession> tls_;
    MessageReader reader_;
    std::uint64_t heard_ = 0;
};

/// State that all attacking threads share.
struct Attack {
    std::uint16_t port;
    const LinkSecurity& security;
    Frames& frames;
    std::mutex mutex{};
    Done done{};

    void visit() {
        base::Bytes frame;
        std::uint32_t greeting = 0, from = 0;
        {
            const std::lock_guard lock(mutex);
            frame = frames.next();
            greeting = frames.below(3);
            from = kLoopback + (1U << 16U) + frames.below(1U << 23U);
        }
        const Socket socket(newSocket());
        if (!socket.connect(from, port)) {
            return;
        }
        Visit connection(socket, security);
        bool sent = false, welcome = false, refused = false;
        try {
            // Sends raw bytes, or a frame in place of the greeting, or a frame after the greeting.
            const bool open =
                greeting == 0 || (connection.agree() && (greeting == 1 || connection.greet(frames.identity())));
            welcome = greeting == 2 && open;
            const std::uint64_t before = connection.heard();
            sent = open && (greeting == 0 ? socket.send(frame) : connection.send(frame));
            connection.end();
            refused = connection.refused();
            welcome = welcome || connection.heard() > before;
        } catch (const std::runtime_error&) {  // a TLS alert also counts as an answer
            welcome = true;
        }
        const std::lock_guard lock(mutex);
        ++done.connections;
        done.frames += sent ? 1 : 0;
        done.read += sent && welcome ? 1 : 0;
        done.refusals += refused ? 1 : 0;
    }
};

}  // namespace

Done attackServer(std::uint16_t port, Frames& frames, std::uint64_t count, const std::function<bool()>& goOn,
                  const LinkSecurity& security) {
    Attack attack{port, security, frames};
    std::vector<std::thread> connections;
    connections.reserve(kConnections);
    std::atomic<std::uint64_t> left{count};
    std::atomic<bool> over{false};
    for (int i = 0; i < kConnections; ++i) {
        connections.emplace_back([&] {
            while (!over && left > 0) {
                attack.visit();
                const std::lock_guard lock(attack.mutex);
                left = count - std::min(count, attack.done.frames);
            }
        });
    }
    Drip unknown(port, kLoopback + 2, encode(Hello{frames.identity()}));
    Drip endless(port, kLoopback + 3, base::Bytes{255, 3, 0, 0});
    while (left > 0 && goOn()) {
        unknown.drip();
        endless.drip();
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    over = true;
    for (std::thread& connection : connections) {
        connection.join();
    }
    return attack.done;
}

FalseServer::FalseServer(std::uint32_t seed, Identity identity, std::uint64_t frames, LinkSecurity security)
    : frames_(seed, std::move(identity)), count_(frames), security_(std::move(security)), listener_(newSocket()) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    if (bind(listener_, reinterpret_cast<const sockaddr*>(&address), size) != 0 || listen(listener_, 8) != 0 ||
        getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
        throw std::system_error(errno, std::generic_category(), "a false server cannot listen");
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
            const int descriptor = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
            if (descriptor >= 0) {
                ++connections_;
                talk(descriptor);
            }
        }
    }
}

void FalseServer::talk(int descriptor) {
    const Socket socket(descriptor);
    Visit visit(socket, security_);
    try {
        if (!visit.agree(true)) {
            return;
        }
        if (!security_.proves() && frames_.below(2) == 0) {
            flood(socket);
        } else if (frames_.below(2) == 0) {
            Identity other = frames_.identity();
            other.rulesDigest ^= 1;
            (void)visit.send(encode(Welcome{frames_.below(2) == 0 ? other : frames_.identity(), 60, Role::watch, {}}));
        }
        bad_ += visit.send(frames_.next()) ? 1 : 0;
        visit.end();
    } catch (const std::exception&) {  // a TLS error, or a bad message of the master
    }
}

/// The master accepts positions with any values.
void FalseServer::flood(const Socket& socket) {
    bool heard = socket.send(encode(PositionGreeting{kProtocolVersion, "false"}));
    for (std::uint64_t i = 0; heard && i < kPerFlood && !stopping_ && !done(); i += 100) {
        base::Bytes many;
        for (int j = 0; j < 100; ++j) {
            const base::Bytes one = frames_.position();
            many.insert(many.end(), one.begin(), one.end());
        }
        heard = socket.send(many);
        positions_ += heard ? 100 : 0;
        socket.drain();
    }
}

}  // namespace hostile
