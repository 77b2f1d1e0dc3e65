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

/// The link between a haptic server, which feels the sand, and the master of a wall, which shows it.
///
/// docs/protocol.md describes every byte. The master is the TCP client; the server owns the device.
namespace haptic_bridge {

inline constexpr std::uint32_t kMagic = 0x42485753;  // "SWHB" as it stands on the wire
inline constexpr std::uint32_t kProtocolVersion = 6;
inline constexpr std::uint16_t kDefaultPort = 7750;
inline constexpr std::size_t kMaxMessage = 64 * 1024;  // [byte], type and payload
inline constexpr std::size_t kMaxGreeting = 1024;      // [byte], of a message before the other side is known
// [byte], of a State, and of an EditRequest or Step with sand that is loaded; and only when one is expected. A field of
// 8192 cells a side compresses to about 150 MiB.
inline constexpr std::size_t kMaxState = 256 * 1024 * 1024;
static_assert(sand::kMaxSandBytes + kMaxMessage <= kMaxState, "a load fits, with the path of its step");
inline constexpr std::size_t kMaxSceneName = 256;  // [byte]
inline constexpr std::size_t kMaxCatchUp = 16;     // steps, of some 1.5 KiB at most each

/// What both sides must have alike before a step may pass.
struct Identity {
    std::uint32_t protocol = kProtocolVersion;
    std::uint32_t algorithm = sand::kAlgorithmVersion;
    std::uint64_t rulesDigest = 0;  // sand::Rules::digest()
    std::string sceneName;
    friend bool operator==(const Identity&, const Identity&) = default;
};

enum class RefusalCode : std::uint8_t {
    garbage = 1,
    protocol,
    algorithm,
    scene,
    busy,
    state,
    secret,
    role,
    tls,
    limit
};
inline constexpr std::array<std::string_view, 10> kRefusalNames{"garbage", "protocol", "algorithm", "scene", "busy",
                                                                "state",   "secret",   "role",      "tls",   "limit"};
/// How often each kind was refused, as kRefusalNames.
using RefusalCounts = std::array<std::uint64_t, kRefusalNames.size()>;

/// What somebody who connects may do; each has a secret of its own.
enum class Role : std::uint8_t { move = 1, watch };  // move the probe and number steps, or be told of them
[[nodiscard]] std::string_view nameOf(Role role);

using Nonce = std::array<std::uint8_t, 32>;     // fresh random bytes for one connection
using MacBytes = std::array<std::uint8_t, 32>;  // HMAC-SHA-256

// Master to server.
struct Hello {
    Identity master;
    Role role = Role::move;
    bool proves = false;  // it has a secret of that role, and wants proof of the server's
    bool tls = false;     // it speaks TLS, as it believes
    Nonce nonce{};
    friend bool operator==(const Hello&, const Hello&) = default;
};
/// The master hands over the numbering: the server's first step is stepNumber + 1 of `epoch`.
struct Start {
    std::uint32_t epoch = 0;
    std::uint64_t stepNumber = 0;
    std::uint64_t stateHash = 0;  // sand::Replica::stateHash() at stepNumber
    friend bool operator==(const Start&, const Start&) = default;
};
struct State {
    base::Bytes bytes;
    friend bool operator==(const State&, const State&) = default;
};
/// Sent after every frame of the wall.
struct Shown {
    std::uint64_t stepNumber = 0;      // the last step that the wall shows
    std::int64_t frameIntervalNs = 0;  // since the frame before
    friend bool operator==(const Shown&, const Shown&) = default;
};
/// How far a timing test has come.
enum class Leg : std::uint8_t {
    received = 1,  // the master has it
    shown,         // the wall has swapped a frame that began after that
};
struct TimingEcho {
    std::uint32_t id = 0;
    Leg leg = Leg::received;
    friend bool operator==(const TimingEcho&, const TimingEcho&) = default;
};
struct Ping {
    std::int64_t masterNs = 0;
    friend bool operator==(const Ping&, const Ping&) = default;
};
/// An operator of the wall asks: the server puts it into its next step.
struct EditRequest {
    sand::Edit edit;
    friend bool operator==(const EditRequest&, const EditRequest&) = default;
};
/// An operator of the wall asks: of its forces, the hand feels this share from now on.
struct ForceShare {
    double share = 1;  // 0 to 1
    friend bool operator==(const ForceShare&, const ForceShare&) = default;
};

/// Answers a Challenge.
struct Proof {
    MacBytes mac{};
    friend bool operator==(const Proof&, const Proof&) = default;
};
/// Steps that a server's replica lacks, after a NeedState that names one the master knows.
struct CatchUp {
    bool last = false;  // no more follow
    std::vector<sand::Step> steps;
    friend bool operator==(const CatchUp&, const CatchUp&) = default;
};

// Server to master.
/// Answers a Hello that proves a secret.
struct Challenge {
    Identity server;  // of a server without sand its device's name alone
    Nonce nonce{};
    friend bool operator==(const Challenge&, const Challenge&) = default;
};
struct Welcome {
    Identity server;
    std::uint32_t stepsPerSecond = 0;
    Role role = Role::move;  // that is granted
    MacBytes mac{};          // the server's proof; zeros without a secret
    friend bool operator==(const Welcome&, const Welcome&) = default;
};
struct Refusal {
    RefusalCode code = RefusalCode::garbage;
    std::string text;
    friend bool operator==(const Refusal&, const Refusal&) = default;
};
struct Ready {
    friend bool operator==(const Ready&, const Ready&) = default;
};
struct NeedState {
    std::uint64_t stepNumber = 0, stateHash = 0;  // where the server's replica is; a hash of 0: nowhere that helps
    friend bool operator==(const NeedState&, const NeedState&) = default;
};
struct StepMessage {
    std::int64_t serverTimeNs = 0;  // server's monotonic clock when the last point of the path was read
    std::uint64_t stateHash = 0;    // of the server's replica after the step
    sand::Step step;
    friend bool operator==(const StepMessage&, const StepMessage&) = default;
};
/// As long on the wire as the step message before it, to be answered once for each Leg.
struct TimingTest {
    std::uint32_t id = 0;
    std::uint32_t padding = 0;  // [byte]
    friend bool operator==(const TimingTest&, const TimingTest&) = default;
};
struct Pong {
    std::int64_t masterNs = 0;  // of the Ping
    std::int64_t serverNs = 0;
    friend bool operator==(const Pong&, const Pong&) = default;
};
/// Half of the way of timing tests there and back, of this link.
struct HalfRoundTrip {
    double msMean = 0, msStddev = 0, msP50 = 0, msP99 = 0;
    std::uint64_t count = 0;
    friend bool operator==(const HalfRoundTrip&, const HalfRoundTrip&) = default;
};
/// What the server has measured since the link came up. A quantity not measured yet is 0.
struct Report {
    double hapticPeriodUsP50 = 0, hapticPeriodUsP99 = 0, hapticPeriodUsMax = 0;  // 0 under --pace fast
    double forceUsP50 = 0, forceUsP99 = 0;                                       // one force evaluation
    HalfRoundTrip toWall, toMaster;                                              // answered when shown, when received
    double stepBytesMean = 0;                     // step messages, length prefix included
    std::uint64_t steps = 0;                      // sent
    std::uint64_t stepsWithheld = 0;              // due, but the wall was a whole window behind
    std::uint64_t samplesDropped = 0;             // hand samples that no step holds: thinned out, let go, or no room
    std::uint64_t ticks = 0;                      // of the force loop; 0 under --pace fast
    std::uint64_t ticksMissed = 0;                // deadlines, each a tick
    std::array<std::uint64_t, kGuards> guards{};  // ticks in which each guard acted, as kGuardNames
    RefusalCounts refused{};                      // by the server since it started
    friend bool operator==(const Report&, const Report&) = default;
};
/// A piece of the tick track, for the master's journal (tick_track.hpp).
struct TickPiece {
    base::Bytes bytes;
    friend bool operator==(const TickPiece&, const TickPiece&) = default;
};

// From a server that has no sand: it streams where the hand is, and the master numbers the steps.
/// Instead of a Welcome, and without having read the Hello.
struct PositionGreeting {
    std::uint32_t protocol = kProtocolVersion;
    std::string name;  // of the device, for a person
    MacBytes mac{};    // the server's proof; zeros without a secret
    friend bool operator==(const PositionGreeting&, const PositionGreeting&) = default;
};
/// In hand space (docs/devices.md).
struct Position {
    std::int64_t timeNs = 0;  // of the server's clock; never runs backwards
    double x = 0, y = 0, z = 0;
    bool engaged = false;
    friend bool operator==(const Position&, const Position&) = default;
};

// Either way.
struct Bye {
    std::string reason;
    friend bool operator==(const Bye&, const Bye&) = default;
};

/// In the order of their type bytes, which count from 1.
using Message = std::variant<Hello, Welcome, Refusal, Start, Ready, NeedState, State, StepMessage, TimingTest, Shown,
                             TimingEcho, Ping, Pong, Report, Bye, EditRequest, ForceShare, TickPiece, PositionGreeting,
                             Position, Challenge, Proof, CatchUp>;

/// The message as it goes over the wire: length, type, payload.
[[nodiscard]] base::Bytes encode(const Message& message);

/// Reads type and payload. Throws base::FormatError for anything that encode() does not write. Of a Hello or Welcome
/// of another protocol version only that version is read.
[[nodiscard]] Message decode(std::span<const std::uint8_t> typeAndPayload);

/// Whether a server with one identity refuses a master with the other, and with which words.
[[nodiscard]] std::optional<Refusal> refusalFor(const Identity& server, const Identity& master);

}  // namespace haptic_bridge
