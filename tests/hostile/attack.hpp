// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <thread>

#include "haptic_bridge/link/handshake.hpp"
#include "tests/hostile/frames.hpp"

namespace hostile {

struct Done {
    std::uint64_t frames = 0;       // that were sent whole, each over a connection of its own
    std::uint64_t read = 0;         // of those: the server had said welcome, or answered; the rest it closed unread
    std::uint64_t connections = 0;  // begun; where the greeting before a frame failed, none was sent
    std::uint64_t refusals = 0;     // Refusal messages that were read
};

/// Sends so many frames to the server at a port of this machine, from many of its addresses (127.x.y.z), one a
/// connection, twelve at once: a third as raw bytes, a third in place of a greeting, a third behind one in good order
/// of somebody who may watch. Two connections drip a byte at a time all the while. `goOn` is asked fifty times a
/// second; `security` is that of one who may watch.
[[nodiscard]] Done attackServer(std::uint16_t port, Frames& frames, std::uint64_t count,
                                const std::function<bool()>& goOn, const haptic_bridge::LinkSecurity& security = {});

class Socket;

/// A server that greets whoever connects with anything and one bad frame, and without a secret floods half of them with
/// positions that are none; until it has sent so much. A thread of its own.
class FalseServer {
public:
    FalseServer(std::uint32_t seed, haptic_bridge::Identity identity, std::uint64_t frames,
                haptic_bridge::LinkSecurity security = {});
    ~FalseServer();
    FalseServer(const FalseServer&) = delete;
    FalseServer& operator=(const FalseServer&) = delete;

    [[nodiscard]] std::uint16_t port() const { return port_; }
    [[nodiscard]] std::uint64_t frames() const { return bad_; }
    [[nodiscard]] std::uint64_t positions() const { return positions_; }  // in good order, of places that are none
    [[nodiscard]] std::uint64_t connections() const { return connections_; }
    [[nodiscard]] bool done() const { return bad_ + positions_ >= count_; }

private:
    void serve();
    void talk(int guest);
    void flood(const Socket& socket);

    Frames frames_;
    const std::uint64_t count_;
    const haptic_bridge::LinkSecurity security_;
    int listener_ = -1;
    std::uint16_t port_ = 0;
    std::atomic<std::uint64_t> bad_{0}, positions_{0}, connections_{0};
    std::atomic<bool> stopping_{false};
    std::thread thread_;
};

}  // namespace hostile
