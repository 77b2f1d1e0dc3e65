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
    std::uint64_t frames = 0;       // frames sent whole, each over a connection of its own
    std::uint64_t read = 0;         // frames that the server welcomed before or answered; the others it closed unread
    std::uint64_t connections = 0;  // connections begun; no frame was sent if the greeting before it failed
    std::uint64_t refusals = 0;     // Refusal messages received
};

/// Sends `count` frames to the server at a port of this machine, one per connection. The connections come from many of
/// the machine's addresses (127.x.y.z), twelve at once. A third of the frames are raw bytes, and a third replace the
/// greeting. The last third follow a correct greeting of a watcher. Two more connections send one byte at a time. Calls
/// `goOn` fifty times a second, and stops when it returns false. `security` holds the secret of a watcher.
[[nodiscard]] Done attackServer(std::uint16_t port, Frames& frames, std::uint64_t count,
                                const std::function<bool()>& goOn, const haptic_bridge::LinkSecurity& security = {});

class Socket;

/// A server that answers every connection with one bad frame, sometimes after a welcome. Without a secret it first
/// floods half of the connections with positions that have bad values. It stops after `frames` frames and positions. It
/// has a thread of its own.
class FalseServer {
public:
    FalseServer(std::uint32_t seed, haptic_bridge::Identity identity, std::uint64_t frames,
                haptic_bridge::LinkSecurity security = {});
    ~FalseServer();
    FalseServer(const FalseServer&) = delete;
    FalseServer& operator=(const FalseServer&) = delete;

    [[nodiscard]] std::uint16_t port() const { return port_; }
    [[nodiscard]] std::uint64_t frames() const { return bad_; }
    [[nodiscard]] std::uint64_t positions() const { return positions_; }  // correctly encoded positions with bad values
    [[nodiscard]] std::uint64_t connections() const { return connections_; }
    [[nodiscard]] bool done() const { return bad_ + positions_ >= count_; }

private:
    void serve();
    void talk(int descriptor);
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
