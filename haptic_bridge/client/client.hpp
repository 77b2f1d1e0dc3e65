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
#include "base/names.hpp"
#include "haptic_bridge/link/address.hpp"
#include "haptic_bridge/link/handshake.hpp"
#include "haptic_bridge/link/protocol.hpp"
#include "haptic_bridge/link/step_ring.hpp"
#include "sand/model/step.hpp"

namespace haptic_bridge {

/// Scene of the master. The handshake compares it with the server's scene.
struct Offer {
    std::uint64_t rulesDigest = 0;  // sand::Rules::digest()
    std::string sceneName;
    sand::StepLimits limits{};  // sand::Rules::stepLimits(); a server whose step is beyond them is refused
};

/// State of the link. In the state `linked` the server numbers the steps. In the states `offered` and `granting` no
/// program numbers steps, and the sand stands still. In all other states the master numbers them, except at the start
/// of a session (master::LiveSteps::kStartWait).
///
/// In the states `connecting`, `refused` and `lost` the client tries to connect again, without end. In the state
/// `loading` it drops a server that does not get on for kLoadingNs.
enum class Link : std::uint8_t {
    connecting,  // no server has answered yet
    refused,     // one side has refused the other; the message says why
    loading,     // the server reads its scene; LinkStatus::loaded says how much of it
    offered,     // the handshake has succeeded: call grant()
    granting,    // grant() is under way
    linked,      // the server numbers the steps of the granted epoch
    streaming,   // the server has no sand and streams positions: the master numbers the steps
    lost,        // an earlier handshake had succeeded, and the connection has ended
    stopped      // stop() was called
};
constexpr auto valuesOf(Link) {
    return std::array{base::Named{Link::connecting, "connecting"}, base::Named{Link::refused, "refused"},
                      base::Named{Link::loading, "loading"},       base::Named{Link::offered, "offered"},
                      base::Named{Link::granting, "granting"},     base::Named{Link::linked, "linked"},
                      base::Named{Link::streaming, "streaming"},   base::Named{Link::lost, "lost"},
                      base::Named{Link::stopped, "stopped"}};
}

/// State of the link, with a line for the user.
struct LinkStatus {
    Link link = Link::connecting;
    std::string message;        // one line with the server's address, and with the reason if the link is down
    std::uint64_t changes = 0;  // grows when there is a new message to print
    std::uint32_t loaded = 0;   // part of its scene that the server has read, by its last Loading, of Loading::kAll
};

/// Step from the server, with its times.
struct TimedStep {
    sand::Step step;
    std::int64_t serverTimeNs = 0;  // of the StepMessage, on the server's clock
    std::uint64_t serverHash = 0;   // state hash of the server's replica after the step
    std::int64_t receivedNs = 0;    // on this host's monotonic clock
};

/// Position of the hand from a server that streams positions.
struct TimedPosition {
    Position position;
    std::int64_t receivedNs = 0;  // on this host's monotonic clock
};

/// Counters of the link since the client was made.
struct LinkCounters {
    std::uint64_t links = 0;                  // handshakes that succeeded, also with a server that streams positions
    std::uint64_t reconnects = 0;             // of these, handshakes after the first
    std::uint64_t bytesIn = 0, bytesOut = 0;  // of the latest connection
    std::uint64_t stepsIn = 0;                // steps that were accepted
    std::uint64_t stepsStale = 0;             // steps that came late or twice, recognised by number and left out
    std::uint64_t stepsForeign = 0;           // steps of another epoch, left out
    std::uint64_t catchUps = 0;               // NeedStates answered with the steps that the server lacked
    std::uint64_t snapshots = 0;              // NeedStates answered with the whole sand
    RefusalCounts refusedHere{};              // servers that refused this master, in the order of valuesOf(RefusalCode)
    RefusalCounts refused{};                  // servers that this master refused; `limit`: a server that never greeted
    /// Adds every counter of `other`.
    void add(const LinkCounters& other);
};

/// Returns a monotonic time [ns] for the link's timeouts. An empty function means the host's clock. Tests pass their
/// own.
using LinkClock = std::function<std::int64_t()>;

/// Faults that a drill injects into the link.
enum class LinkDrill : std::uint8_t {
    garbage,  // the client sends random bytes instead of a message
    silence   // the client neither reads nor sends for a given time, as if a cable were pulled
};

/// Master's end of the link. Connects to the haptic server, again and again if necessary, and gives out its steps.
///
/// Threads: the client has a network thread of its own. Any thread may call every member function. Only stop() and the
/// destructor wait for the network. No failure of the network throws; link() reports it.
///
/// Order of calls:
/// 1. Poll link() until the link is `offered`.
/// 2. Call drain() for the steps of the last epoch, then grant(). While the link is `granting`, answer needsState().
/// 3. While the link is `linked`, drain() the steps and apply them. Call shown() after every frame of the wall.
/// 4. When the link is no longer `linked`, drain() the remaining steps. Then the master numbers the steps, in a new
///    epoch.
///
/// In the state `streaming`, drainPositions() returns the positions of the hand, and the master numbers the steps.
class Client {
public:
    /// Starts to connect. If `security` has no secret, the client refuses a server on another machine.
    Client(Address address, Offer offer, LinkSecurity security = {}, LinkClock clock = {});
    ~Client();
    Client(const Client&) = delete;
    Client& operator=(const Client&) = delete;

    [[nodiscard]] LinkStatus link() const;
    /// Lets the server number the steps of `epoch`, from `stepNumber` + 1 on. Drops steps that were not drained.
    /// Ignored unless the link is `offered`.
    ///
    /// `stateHash` belongs to step `stepNumber`. If the server's replica has the sand after a step in `recent`, it gets
    /// only the steps that it lacks. Otherwise it needs the whole sand.
    void grant(std::uint32_t epoch, std::uint64_t stepNumber, std::uint64_t stateHash, StepRing recent = {});
    /// Returns whether the server needs the whole sand after the granted step. Call giveState() then.
    [[nodiscard]] bool needsState() const;
    /// Sends the whole sand (sand::Replica::encodeState()). Ignored unless needsState().
    void giveState(base::Bytes state);
    /// Returns at most `most` steps of the granted epoch, in order and without gaps.
    ///
    /// A server is at most StepMaker::kWindow steps ahead of shown(). Against a server that ignores this, the network
    /// thread stops reading when kMaxQueued steps wait, until this is called. TCP then holds the server back.
    [[nodiscard]] std::vector<TimedStep> drain(std::size_t most);
    /// Tells the server that the wall has swapped and what it shows. The server may then send further steps.
    ///
    /// Also answers the timing tests that came before the frame's steps were drained. Like a step, a test that comes
    /// while a frame is drawn belongs to the next frame.
    void shown(const Shown& frame);
    /// Asks the server to put an operator's edit into its next step. Ignored unless the link is `linked`.
    void request(const sand::Edit& edit);
    /// Sets the share of the server's force that the hand feels from now on, also in later links. At first it is the
    /// whole force, within the server's own options.
    void shareForce(const ForceShare& share);
    /// Returns the pieces of the server's tick track since the last call. The journal keeps them. Pieces that came
    /// before the link ended can still be drained. kMaxTicks bytes can wait; later pieces are dropped.
    [[nodiscard]] std::vector<base::Bytes> drainTicks();
    /// Returns the positions of a streaming server since the last call, in order. When kMaxPositions wait, the network
    /// thread stops reading until this is called.
    [[nodiscard]] std::vector<TimedPosition> drainPositions();
    /// Returns how often the network thread stopped reading because kMaxPositions positions waited.
    [[nodiscard]] std::uint64_t floods() const;
    /// Returns server's clock − this host's clock [ns]; 0 before the first Pong.
    [[nodiscard]] std::int64_t clockOffsetNs() const;
    /// Returns the server's latest report, also after the link is lost; nullopt before the first report. Its `audited`
    /// is that of the latest link.
    [[nodiscard]] std::optional<Report> report() const;
    [[nodiscard]] LinkCounters counters() const;
    /// Returns why the last attempt to link has failed: the text of a refusal, or "no answer" with the reason in
    /// brackets. Returns an empty text if no attempt has failed since the last handshake that succeeded.
    [[nodiscard]] std::string lastFailure() const;
    /// Returns the steps per second of the server's scene; 0 before the link was first `offered`.
    [[nodiscard]] std::uint32_t stepsPerSecond() const;
    /// Returns the share of the force that shareForce() cannot exceed, because the server's own options are a ceiling;
    /// nullopt unless the link is `linked`.
    [[nodiscard]] std::optional<double> forceCeiling() const;
    /// Injects a fault into the connection. Ignored without a connection. `length` is for LinkDrill::silence.
    void drill(LinkDrill drill, std::chrono::milliseconds length);
    /// Says goodbye, waits at most half a second for the server's last report, and ends the network thread.
    void stop();

    static constexpr std::size_t kMaxQueued = 1024;      // [step] that may wait
    static constexpr std::size_t kMaxPositions = 16384;  // [position] that may wait, 1 s of a device read at 16 kHz
    static constexpr std::size_t kMaxTicks = 8 << 20;    // [byte] of tick pieces that may wait, 1.5 min of a hand

private:
    class Conversation;
    std::unique_ptr<Conversation> conversation_;
};

}  // namespace haptic_bridge
