// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <thread>

#include "tests/hostile/frames.hpp"

namespace hostile {

struct Done {
    std::uint64_t frames = 0, connections = 0, refusals = 0;  // refusals: Refusal messages that were read
};

/// Sends so many frames to the server at a port of this machine, from many of its addresses (127.x.y.z), eight a
/// connection; half of them after a greeting in good order. Two connections drip a byte at a time all the while.
/// `goOn` is asked before each connection.
[[nodiscard]] Done attackServer(std::uint16_t port, Frames& frames, std::uint64_t count,
                                const std::function<bool()>& goOn);

/// A server that greets whoever connects with anything, and floods who streams with positions that are none; until it
/// has sent so many frames. A thread of its own.
class FalseServer {
public:
    FalseServer(std::uint32_t seed, haptic_bridge::Identity identity, std::uint64_t frames);
    ~FalseServer();
    FalseServer(const FalseServer&) = delete;
    FalseServer& operator=(const FalseServer&) = delete;

    [[nodiscard]] std::uint16_t port() const { return port_; }
    [[nodiscard]] std::uint64_t frames() const { return sent_; }
    [[nodiscard]] std::uint64_t connections() const { return connections_; }
    [[nodiscard]] bool done() const { return sent_ >= count_; }

private:
    void serve();
    void talk(int guest);

    Frames frames_;
    const std::uint64_t count_;
    int listener_ = -1;
    std::uint16_t port_ = 0;
    std::atomic<std::uint64_t> sent_{0}, connections_{0};
    std::atomic<bool> stopping_{false};
    std::thread thread_;
};

}  // namespace hostile
