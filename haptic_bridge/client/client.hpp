// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/byte_stream.hpp"
#include "haptic_bridge/link/address.hpp"
#include "haptic_bridge/link/handshake.hpp"
#include "haptic_bridge/link/protocol.hpp"
#include "haptic_bridge/link/step_ring.hpp"
#include "sand/model/step.hpp"

namespace haptic_bridge {

/// What the master compares with the server at the handshake.
struct Offer {
    std::uint64_t rulesDigest = 0;  // sand::Rules::digest()
    std::string sceneName;
};

/// Where the link stands. Only a linked server numbers steps; in every other state the master does.
enum class Link : std::uint8_t {
    connecting,  // nobody answers yet; tried again for ever
    refused,     // one side refused the other, see the message; tried again for ever
    offered,     // the handshake fits: call grant()
    granting,    // grant() is under way
    linked,      // the server numbers the steps of the granted epoch
    streaming,   // the server has no sand and streams positions: the master numbers the steps
    lost,        // was offered or more, and is gone; tried again for ever
    stopped
};

struct LinkStatus {
    Link link = Link::connecting;
    std::string message;        // one line for a person: with whom, and why not
    std::uint64_t changes = 0;  // grows whenever link or message changes: print the message then
};

struct TimedStep {
    sand::Step step;
    std::int64_t serverTimeNs = 0;  // server's clock, when the hand was read last
    std::uint64_t serverHash = 0;   // state hash of the server's replica after the step
    std::int64_t receivedNs = 0;    // this host's monotonic clock
};

/// Where a hand was, from a server that streams positions.
struct TimedPosition {
    Position position;
    std::int64_t receivedNs = 0;  // this host's monotonic clock
};

struct LinkCounters {
    std::uint64_t links = 0;       // handshakes that fitted, of servers that stream positions, too
    std::uint64_t reconnects = 0;  // handshakes after the first
    std::uint64_t bytesIn = 0, bytesOut = 0;
    std::uint64_t stepsIn = 0;       // accepted
    std::uint64_t stepsStale = 0;    // late or doubled: recognised by number, left out
    std::uint64_t stepsForeign = 0;  // of another epoch: left out
    std::uint64_t catchUps = 0;      // hand-overs by the steps that the server lacked
    std::uint64_t snapshots = 0;     // and by the whole sand
    RefusalCounts refusedHere{};     // by the server: it would not have this master, as kRefusalNames
    RefusalCounts refused{};         // servers that this master refused; `limit`: one that never greeted
    void add(const LinkCounters& other);
};

/// Returns a monotonic time [ns]. The link's timeouts use it. An empty function stands for the host's clock; a test
/// passes its own.
using LinkClock = std::function<std::int64_t()>;

/// Faults of the link on purpose.
enum class LinkDrill : std::uint8_t {
    garbage,  // the server is sent bytes that are no message
    silence   // nothing is read or sent for a while, as when a cable is pulled
};

/// The master's end of the link: connects by itself, for ever, and hands over steps in order.
///
/// Has a network thread of its own. Every member may be called from any thread, returns at once and, whatever the
/// network does, throws nothing; the link's troubles are told by link().
///
/// Order of calls: poll link(); when it is offered, drain() what is left, then grant() with the replica's state; while
/// it is linked, drain() and apply, and call shown() after every frame of the wall. When link() is anything else, the
/// server numbers no steps: what it had sent is still there to drain(), and then the master numbers on, in a new epoch.
class Client {
public:
    /// Without a secret in `security` only servers on this machine are spoken to.
    Client(Address address, Offer offer, LinkSecurity security = {}, LinkClock clock = {});
    ~Client();
    Client(const Client&) = delete;
    Client& operator=(const Client&) = delete;

    [[nodiscard]] LinkStatus link() const;
    /// Lets the server number the steps of `epoch`, from stepNumber + 1 on. `state` is
    /// sand::Replica::encodeState() at stepNumber, sent only when the server's replica is elsewhere, and not on the
    /// way of the steps in `recent`. Drops steps that were not drained. Without effect unless the link is offered.
    void grant(std::uint32_t epoch, std::uint64_t stepNumber, std::uint64_t stateHash, base::Bytes state,
               StepRing recent = {});
    /// At most `most` steps, in order and without gaps, of the granted epoch only. When the queue is full (kMaxQueued),
    /// the network thread stops reading, and TCP holds the server back.
    [[nodiscard]] std::vector<TimedStep> drain(std::size_t most);
    /// The wall has swapped, and shows this step. Lets the server go on, and answers the timing tests that came before
    /// the frame's steps were drained: like a step, a test that comes while a frame is drawn is in the next.
    void shown(std::uint64_t stepNumber, std::int64_t frameIntervalNs);
    /// An operator asks: the server puts it into its next step. Without effect unless the server is linked.
    void request(const sand::Edit& edit);
    /// Of its forces, the hand feels this share from now on, 0 to 1. Without effect unless the server is linked.
    void shareForce(double share);
    /// Pieces of the server's tick track, for the journal; what is left when the link has ended, too.
    [[nodiscard]] std::vector<base::Bytes> drainTicks();
    /// What a streaming server has sent, in order; when kMaxPositions wait, the network thread stops reading.
    [[nodiscard]] std::vector<TimedPosition> drainPositions();
    /// How often that was so.
    [[nodiscard]] std::uint64_t floods() const;
    /// Server's clock − this host's clock [ns]; 0 before the first exchange.
    [[nodiscard]] std::int64_t clockOffsetNs() const;
    /// The server's latest measurements; kept when the link is lost.
    [[nodiscard]] std::optional<Report> report() const;
    [[nodiscard]] LinkCounters counters() const;
    /// From the server's scene, once offered; 0 before.
    [[nodiscard]] std::uint32_t stepsPerSecond() const;
    /// Does that to the connection there is, if there is one; `length` is of a silence.
    void drill(LinkDrill drill, std::chrono::milliseconds length);
    /// Says goodbye, waits at most half a second for the server's last report, and ends the network thread.
    void stop();

    /// Silence that ends a link. Pongs come four times a second.
    static constexpr std::int64_t kSilenceNs = 10'000'000'000;
    static constexpr std::size_t kMaxQueued = 1024;      // [step]
    static constexpr std::size_t kMaxPositions = 16384;  // a second of a device that is read 16 times a millisecond

private:
    class Session;
    std::unique_ptr<Session> session_;
};

}  // namespace haptic_bridge
