// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "base/byte_stream.hpp"
#include "haptic_bridge/hand/guard_counts.hpp"
#include "sand/model/step.hpp"
#include "scene/scene.hpp"

/// Messages of the link between a haptic server, which owns the device, and the master of a wall.
///
/// The master is the TCP client. docs/protocol.md describes every byte. All time stamps are in ns, on the monotonic
/// clock of the side that is named.
namespace haptic_bridge {

inline constexpr std::uint32_t kMagic = 0x42485753;  // the bytes "SWHB" on the wire
inline constexpr std::uint32_t kProtocolVersion = 7;
inline constexpr std::uint16_t kDefaultPort = 7750;
inline constexpr std::size_t kMaxMessage = 64 * 1024;  // [byte], type and payload of an ordinary message
inline constexpr std::size_t kMaxGreeting = 1024;      // [byte], type and payload of a message before the Welcome
// [byte], type and payload of a message with sand: a State, or an EditRequest or Step that loads sand. Accepted only
// when such a message is expected. A field of 8192 × 8192 cells compresses to about 150 MiB.
inline constexpr std::size_t kMaxState = 256 * 1024 * 1024;
static_assert(sand::kMaxSandBytes + kMaxMessage <= kMaxState, "a load fits, with the path of its step");
inline constexpr std::size_t kMaxSceneName = 256;  // [byte], also for the name of a device
inline constexpr std::size_t kMaxReason = 512;     // [byte] of the reason in a Refusal or a Bye; the rest is cut off
inline constexpr std::size_t kMaxCatchUp = 16;     // [step] in one CatchUp; a step takes at most about 1.5 KiB

/// Versions and scene of one side. Both sides must have the same before the server may send steps.
struct Identity {
    std::uint32_t protocol = kProtocolVersion;
    std::uint32_t algorithm = sand::kAlgorithmVersion;
    std::uint64_t rulesDigest = 0;  // sand::Rules::digest()
    std::string sceneName;
    friend bool operator==(const Identity&, const Identity&) = default;
};

/// Reason why one side refuses the other.
enum class RefusalCode : std::uint8_t {
    garbage = 1,  // bytes that are not a message, or a message out of turn
    protocol,     // another protocol version
    algorithm,    // another algorithm version of the sand
    scene,        // another scene, material or tool
    busy,         // a master is linked already, or too many watchers
    state,        // a State that does not fit
    secret,       // a secret that is missing on one side, or different
    role,         // the secret of another role, or a watcher that sends more than Ping and Bye
    tls,          // TLS on one side only
    limit         // too many or too frequent connections, too many bytes, or silence
};
inline constexpr std::array<std::string_view, 10> kRefusalNames{"garbage", "protocol", "algorithm", "scene", "busy",
                                                                "state",   "secret",   "role",      "tls",   "limit"};
/// Number of refusals with each code, in the order of kRefusalNames.
using RefusalCounts = std::array<std::uint64_t, kRefusalNames.size()>;

/// Rights of a connection. Each role has a secret of its own.
enum class Role : std::uint8_t {
    move = 1,  // a master: lets the server number the steps, and may send edits
    watch      // a watcher: receives the steps, and sends only Ping and Bye
};
[[nodiscard]] std::string_view nameOf(Role role);

using Nonce = std::array<std::uint8_t, 32>;     // random bytes, new for each connection
using MacBytes = std::array<std::uint8_t, 32>;  // HMAC-SHA-256

// Messages from the master to the server.

/// First message of a master or a watcher.
struct Hello {
    Identity master;
    Role role = Role::move;
    bool proves = false;  // it has a secret of `role`, and the server must prove the same secret
    bool tls = false;     // the sender uses TLS; the server refuses if its own end of the connection does not
    Nonce nonce{};        // zeros without a secret
    friend bool operator==(const Hello&, const Hello&) = default;
};
/// Sets the share of its forces that the hand feels from now on. Part of every Start, and sent after every change.
struct ForceShare {
    double share = 1;  // 0 to 1
    // Whether an operator of this session has set the share. If not, the server's own --force and --force-scale are a
    // ceiling.
    bool byOperator = false;
    friend bool operator==(const ForceShare&, const ForceShare&) = default;
};
/// Lets the server number the steps. The server's first step is stepNumber + 1 of `epoch`.
struct Start {
    std::uint32_t epoch = 0;
    std::uint64_t stepNumber = 0;
    std::uint64_t stateHash = 0;  // sand::Replica::stateHash() at stepNumber
    ForceShare force{};           // of this link's first tick; between two links the server pushes 0
    friend bool operator==(const Start&, const Start&) = default;
};
/// The whole sand at Start's step. Answers a NeedState.
struct State {
    base::Bytes bytes;  // of sand::Replica::encodeState()
    friend bool operator==(const State&, const State&) = default;
};
/// Reason why the wall takes no steps, although it shows frames.
enum class Held : std::uint8_t {
    no,    // it takes steps
    disk,  // the journal's disk has no room
    pause  // an operator has paused the sand
};
/// Tells the server which step the wall shows. Sent after every frame of the wall.
struct Shown {
    std::uint64_t stepNumber = 0;      // the last step that the wall shows
    std::int64_t frameIntervalNs = 0;  // from the swap of the frame before to the swap of this frame
    Held held = Held::no;
    friend bool operator==(const Shown&, const Shown&) = default;
};
/// Point at which the master answers a timing test.
enum class Leg : std::uint8_t {
    received = 1,  // the master has received the test
    shown,         // the wall has swapped the first frame that began after the test was received
};
/// Answers a TimingTest, once for each Leg.
struct TimingEcho {
    std::uint32_t id = 0;  // of the TimingTest
    Leg leg = Leg::received;
    friend bool operator==(const TimingEcho&, const TimingEcho&) = default;
};
/// Asks for the server's clock, four times a second. A server drops a master that is silent for 10 s.
struct Ping {
    std::int64_t masterNs = 0;  // master's clock when it sends the Ping
    friend bool operator==(const Ping&, const Ping&) = default;
};
/// Asks for an operator's edit. The server puts it into its next step.
struct EditRequest {
    sand::Edit edit;
    friend bool operator==(const EditRequest&, const EditRequest&) = default;
};

/// Proves to the server that the master knows the secret. Answers a Challenge.
struct Proof {
    MacBytes mac{};
    friend bool operator==(const Proof&, const Proof&) = default;
};
/// Steps that the server's replica lacks up to Start's step. Answers a NeedState if the master still has all of them.
struct CatchUp {
    bool last = false;  // the last CatchUp of this answer
    std::vector<sand::Step> steps;
    friend bool operator==(const CatchUp&, const CatchUp&) = default;
};

// Messages from the server to the master.

/// Asks for proof of the secret. Answers a Hello whose `proves` is true.
struct Challenge {
    Identity server;  // a server without sand sends algorithm 0, digest 0 and the name of its device
    Nonce nonce{};
    friend bool operator==(const Challenge&, const Challenge&) = default;
};
/// Accepts the connection.
struct Welcome {
    Identity server;
    std::uint32_t stepsPerSecond = 0;  // of the server's scene
    Role role = Role::move;            // the role that the server grants
    MacBytes mac{};                    // proves that the server knows the secret; zeros without a secret
    friend bool operator==(const Welcome&, const Welcome&) = default;
};
/// Refuses the connection. The server then closes it.
struct Refusal {
    RefusalCode code = RefusalCode::garbage;
    std::string text;  // one line for the user: the reason, and what to do
    friend bool operator==(const Refusal&, const Refusal&) = default;
};
/// Answers Start as soon as the server's replica has the same sand. Steps follow.
struct Ready {
    friend bool operator==(const Ready&, const Ready&) = default;
};
/// Asks for the sand of Start, because the server's replica differs. The master answers with CatchUps or a State.
struct NeedState {
    std::uint64_t stepNumber = 0, stateHash = 0;  // of the server's replica; 0 and 0 ask for a State
    friend bool operator==(const NeedState&, const NeedState&) = default;
};
/// One step of the sand. The master gets all steps. Watchers get only the steps that load no sand.
struct StepMessage {
    std::int64_t serverTimeNs = 0;  // server's clock at the step's last hand sample, or when it made the step
    std::uint64_t stateHash = 0;    // of the server's replica after the step
    sand::Step step;
    friend bool operator==(const StepMessage&, const StepMessage&) = default;
};
/// Measures the round trip. The master answers it once for each Leg.
struct TimingTest {
    std::uint32_t id = 0;
    std::uint32_t padding = 0;  // [byte]; makes the test as long as the last step message without loaded sand
    friend bool operator==(const TimingTest&, const TimingTest&) = default;
};
/// Answers a Ping.
struct Pong {
    std::int64_t masterNs = 0;  // copied from the Ping
    std::int64_t serverNs = 0;  // server's clock when it answers
    friend bool operator==(const Pong&, const Pong&) = default;
};
/// Half of the round-trip time of this link's timing tests.
struct HalfRoundTrip {
    double msMean = 0, msStddev = 0, msP50 = 0, msP99 = 0;  // [ms]
    std::uint64_t count = 0;                                // timing tests that were answered
    friend bool operator==(const HalfRoundTrip&, const HalfRoundTrip&) = default;
};
/// Causes for which a server withholds a step that is due, because the wall is a whole window behind.
enum class Withheld : std::uint8_t {
    wall,   // the wall is slow
    disk,   // Held::disk
    pause,  // Held::pause
    start   // no Shown has come on this link yet
};
inline constexpr std::array<std::string_view, 4> kWithheldNames{"wall", "disk", "pause", "start"};
/// Number of withheld steps with each cause, in the order of kWithheldNames.
using WithheldCounts = std::array<std::uint64_t, kWithheldNames.size()>;
[[nodiscard]] std::uint64_t inAll(const WithheldCounts& counts);

/// Result of the audit of the server's whole replica, which hashes its sand again from memory.
enum class Audited : std::uint8_t {
    no,      // not audited
    agreed,  // the memory has the state hash that the server has sent
    differed
};
/// Measurements of the server, sent once a second. A value that has not been measured yet is 0.
///
/// Round trips, stepBytesMean and `steps` count since the link began. All other values count since the server started.
struct Report {
    double hapticPeriodUsP50 = 0, hapticPeriodUsP99 = 0, hapticPeriodUsMax = 0;  // [us]; 0 under --pace fast
    double forceUsP50 = 0, forceUsP99 = 0;                                       // [us], of one force evaluation
    HalfRoundTrip toWall, toMaster;                                              // of Leg::shown, of Leg::received
    double stepBytesMean = 0;                     // [byte], of a step message with its length prefix
    std::uint64_t steps = 0;                      // steps that were sent
    WithheldCounts stepsWithheld{};               // steps that were due while the wall was a whole window behind
    std::uint64_t samplesDropped = 0;             // hand samples in no step: thinned out, outdated, or queue full
    std::uint64_t ticks = 0;                      // of the force loop; 0 under --pace fast
    std::uint64_t ticksMissed = 0;                // ticks whose deadline the force loop missed
    std::array<std::uint64_t, kGuards> guards{};  // ticks in which each guard acted, in the order of kGuardNames
    RefusalCounts refused{};                      // connections that the server refused
    std::uint64_t handTicks = 0;                  // ticks while a master was linked, under both paces
    std::uint64_t feltTicks = 0;                  // of these, ticks that pushed a force above 0
    std::uint64_t faultedTicks = 0;               // of these, ticks in which a fault pushed 0 (kFaults)
    bool literal = false;                         // the server runs with --guards literal
    Audited audited = Audited::no;                // agreed or differed only in the last report of a link
    friend bool operator==(const Report&, const Report&) = default;
};
/// Piece of the tick track (haptic_bridge/loop/tick_track.hpp). The master writes it to its journal.
struct TickPiece {
    base::Bytes bytes;
    friend bool operator==(const TickPiece&, const TickPiece&) = default;
};

// Messages from a server without sand. It streams positions of the hand, and the master numbers the steps.

/// Takes the place of the Welcome. A server without a secret sends it at once, without reading the Hello.
struct PositionGreeting {
    std::uint32_t protocol = kProtocolVersion;
    std::string name;  // of the device, to be printed
    MacBytes mac{};    // proves that the server knows the secret; zeros without a secret
    friend bool operator==(const PositionGreeting&, const PositionGreeting&) = default;
};
/// Pose of the hand.
struct Position {
    std::int64_t timeNs = 0;     // server's clock; never runs backwards
    double x = 0, y = 0, z = 0;  // in hand space, with the units of Pose
    bool engaged = false;        // the tool may touch the sand
    friend bool operator==(const Position&, const Position&) = default;
};

// Messages of both sides.

/// Ends the link in an orderly way.
struct Bye {
    std::string reason;  // one line, to be printed
    friend bool operator==(const Bye&, const Bye&) = default;
};

/// One message of any type. The type byte on the wire is the type's place in this list, counted from 1.
using Message = std::variant<Hello, Welcome, Refusal, Start, Ready, NeedState, State, StepMessage, TimingTest, Shown,
                             TimingEcho, Ping, Pong, Report, Bye, EditRequest, ForceShare, TickPiece, PositionGreeting,
                             Position, Challenge, Proof, CatchUp>;

/// Returns the bytes of `message` on the wire: length, type, payload.
[[nodiscard]] base::Bytes encode(const Message& message);

/// Returns the message that `typeAndPayload` holds. Throws base::FormatError if the type is unknown, if the payload is
/// too short or too long, or if a value is out of bounds.
///
/// If a Hello, Challenge, Welcome or PositionGreeting has another protocol version, only that version is read.
/// Accepts a Position whose numbers are not finite, so that the master can report the device. Replaces control
/// characters in texts by '?', because these texts are printed.
[[nodiscard]] Message decode(std::span<const std::uint8_t> typeAndPayload);

}  // namespace haptic_bridge
