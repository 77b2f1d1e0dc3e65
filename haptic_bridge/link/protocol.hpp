// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "base/field_forms.hpp"
#include "haptic_bridge/hand/frame_cost.hpp"
#include "haptic_bridge/hand/held.hpp"
#include "haptic_bridge/link/greetings.hpp"
#include "haptic_bridge/link/message_forms.hpp"
#include "haptic_bridge/link/report.hpp"
#include "sand/model/step.hpp"
#include "scene/model/scene.hpp"

/// Messages of the link between a haptic server, which owns the device, and the master of a wall.
///
/// The master is the TCP client. docs/protocol.md describes every byte. All time stamps are in ns, on the monotonic
/// clock of the side that is named.
namespace haptic_bridge {

inline constexpr std::uint16_t kDefaultPort = 7750;
inline constexpr std::size_t kMaxMessage = 64 * 1024;  // [byte], type and payload of an ordinary message
inline constexpr std::size_t kMaxGreeting = 1024;      // [byte], type and payload of a message before the Welcome
// [byte], type and payload of a message with sand: a State, or an EditRequest that loads sand. Accepted only when such
// a message is expected. A field of 8192 × 8192 cells compresses to about 150 MiB. Those of a larger field may be
// longer (sand::Start::mostStateBytes(), sand::Rules::stepLimits()).
inline constexpr std::size_t kMaxState = 256 * 1024 * 1024;
static_assert(static_cast<std::size_t>(sand::kMaxSandBytes) + kMaxMessage <= kMaxState, "a load fits");
inline constexpr std::size_t kMaxReason = 512;  // [byte] of the reason in a Refusal or a Bye; the rest is cut off
inline constexpr std::size_t kMaxCatchUp = 16;  // [step] in one CatchUp; a step takes at most about 1.5 KiB
// [ns], silence of the other side after which either end drops the link. Each end sends a message once a second or more
// often.
inline constexpr std::int64_t kSilenceNs = 10'000'000'000;
// [ns], time in which a server that reads its scene must do another hundredth of that work. After it the master drops
// the link.
inline constexpr std::int64_t kLoadingNs = 120'000'000'000;

// Messages from the master to the server.

/// Sets the share of its forces that the hand feels from now on. Part of every Start, and sent after every change.
struct ForceShare {
    double share = 1;  // 0 to 1
    // Whether an operator of this session has set the share. It may then exceed the own --force and --force-scale of a
    // server with --force-until-ctl.
    bool byOperator = false;
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("share", base::limited(it.share, 0, 1));
        visit("by_operator", it.byOperator);
    }
    friend bool operator==(const ForceShare&, const ForceShare&) = default;
};
/// Lets the server number the steps. The server's first step is stepNumber + 1 of `epoch`.
struct StartMessage {
    std::uint32_t epoch = 0;
    std::uint64_t stepNumber = 0;
    std::uint64_t stateHash = 0;  // sand::Replica::stateHash() at stepNumber
    ForceShare force{};           // of this link's first tick; between two links the server pushes 0
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("epoch", it.epoch);
        visit("step", it.stepNumber);
        visit("state_hash", it.stateHash);
        visit("force", it.force);
    }
    friend bool operator==(const StartMessage&, const StartMessage&) = default;
};
/// The whole sand at Start's step. Answers a NeedState.
struct State {
    base::Bytes bytes;  // of sand::Replica::encodeState()
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("bytes", base::rest(it.bytes));
    }
    friend bool operator==(const State&, const State&) = default;
};
/// Tells the server which step the wall shows. Sent after every frame of the wall.
struct Shown {
    std::uint64_t stepNumber = 0;      // the last step that the wall shows
    std::int64_t frameIntervalNs = 0;  // from the swap of the frame before to the swap of this frame
    Held held = Held::no;
    FrameCost cost{};  // of this frame, on the slowest host
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("step", it.stepNumber);
        visit("frame_interval_ns", it.frameIntervalNs);
        visit("held", it.held);
        visit("cost", it.cost);
    }
    friend bool operator==(const Shown&, const Shown&) = default;
};
/// Point at which the master answers a timing test.
enum class Leg : std::uint8_t {
    received = 1,  // the master has received the test
    shown,         // the wall has swapped the first frame that began after the test was received
};
constexpr auto valuesOf(Leg) {
    return std::array{base::Named{Leg::received, "received"}, base::Named{Leg::shown, "shown"}};
}
/// Answers a TimingTest, once for each Leg.
struct TimingEcho {
    std::uint32_t id = 0;  // of the TimingTest
    Leg leg = Leg::received;
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("id", it.id);
        visit("leg", it.leg);
    }
    friend bool operator==(const TimingEcho&, const TimingEcho&) = default;
};
/// Asks for the server's clock, four times a second. A server drops a master that is silent for 10 s.
struct Ping {
    std::int64_t masterNs = 0;  // master's clock when it sends the Ping
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("master_ns", it.masterNs);
    }
    friend bool operator==(const Ping&, const Ping&) = default;
};
/// Asks for an operator's edit. The server puts it into its next step, with the edit's number and without its sand.
struct EditRequest {
    sand::Edit edit;
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("edit", WholeEdit{it.edit});
    }
    friend bool operator==(const EditRequest&, const EditRequest&) = default;
};

/// Steps that the server's replica lacks up to Start's step. Answers a NeedState if the master still has all of them.
struct CatchUp {
    bool last = false;  // the last CatchUp of this answer
    std::vector<sand::Step> steps;
    [[nodiscard]] std::string refusal() const;
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("last", it.last);
        visit("steps", base::upTo<std::uint16_t>(it.steps, kMaxCatchUp));
    }
    friend bool operator==(const CatchUp&, const CatchUp&) = default;
};

// Messages from the server to the master.

/// Answers Start as soon as the server's replica has the same sand. Steps follow.
struct Ready {
    double forceCeiling = 1;  // share of the force that no message lifts, 0 to 1
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("force_ceiling", base::limited(it.forceCeiling, 0, 1));
    }
    friend bool operator==(const Ready&, const Ready&) = default;
};
/// Asks for the sand of Start, because the server's replica differs. The master answers with CatchUps or a State.
struct NeedState {
    std::uint64_t stepNumber = 0, stateHash = 0;  // of the server's replica; 0 and 0 ask for a State
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("step", it.stepNumber);
        visit("state_hash", it.stateHash);
    }
    friend bool operator==(const NeedState&, const NeedState&) = default;
};
/// One step of the sand. A load in it has no sand, because the master has the sand and knows the edit by its number.
struct StepMessage {
    // Server's clock at the step's last hand sample, or when it made the step. 0 if the hand waited for sweeps that are
    // owed.
    std::int64_t serverTimeNs = 0;
    std::uint64_t stateHash = 0;  // of the server's replica after the step
    sand::Step step;
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("server_ns", it.serverTimeNs);
        visit("state_hash", it.stateHash);
        visit("step", it.step);
    }
    friend bool operator==(const StepMessage&, const StepMessage&) = default;
};
/// Measures the round trip. The master answers it once for each Leg.
struct TimingTest {
    std::uint32_t id = 0;
    std::uint32_t padding = 0;  // [byte]; makes the test as long as the last step message
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("id", it.id);
        visit("padding", base::padding(it.padding));
    }
    friend bool operator==(const TimingTest&, const TimingTest&) = default;
};
/// Answers a Ping.
struct Pong {
    std::int64_t masterNs = 0;  // copied from the Ping
    std::int64_t serverNs = 0;  // server's clock when it answers
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("master_ns", it.masterNs);
        visit("server_ns", it.serverNs);
    }
    friend bool operator==(const Pong&, const Pong&) = default;
};
/// Piece of the tick track (haptic_bridge/loop/tick_track.hpp). The master writes it to its journal.
struct TickPiece {
    base::Bytes bytes;
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("bytes", base::rest(it.bytes));
    }
    friend bool operator==(const TickPiece&, const TickPiece&) = default;
};

// Messages from a server without sand. It streams positions of the hand, and the master numbers the steps.

/// Pose of the hand.
struct Position {
    std::int64_t timeNs = 0;     // server's clock; never runs backwards
    double x = 0, y = 0, z = 0;  // in hand space, with the units of Pose
    bool engaged = false;        // the tool may touch the sand
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("time_ns", it.timeNs);
        visit("x", base::anyFloat(it.x));
        visit("y", base::anyFloat(it.y));
        visit("z", base::anyFloat(it.z));
        visit("engaged", it.engaged);
    }
    friend bool operator==(const Position&, const Position&) = default;
};

// Messages of both sides.

/// Ends the link in an orderly way.
struct Bye {
    std::string reason;  // one line, to be printed
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("reason", Reason{it.reason});
    }
    friend bool operator==(const Bye&, const Bye&) = default;
};

/// One message of any type. The type byte on the wire is the type's place in this list, counted from 1.
using Message = std::variant<Hello, Welcome, Refusal, StartMessage, Ready, NeedState, State, StepMessage, TimingTest,
                             Shown, TimingEcho, Ping, Pong, Report, Bye, EditRequest, ForceShare, TickPiece,
                             PositionGreeting, Position, Challenge, Proof, CatchUp, Loading>;

/// Returns the bytes of `message` on the wire: length, type, payload.
[[nodiscard]] base::Bytes encode(const Message& message);
inline constexpr std::size_t kLengthBytes = sizeof(std::uint32_t);  // before the type
/// Returns the length of type and payload of the message that begins a stream of kLengthBytes or more.
[[nodiscard]] std::uint32_t framedLength(std::span<const std::uint8_t> stream);

/// Returns the message that `typeAndPayload` holds. Throws base::FormatError if the type is unknown, if the payload is
/// too short or too long, or if a value is out of bounds.
///
/// If a Hello, Challenge, Welcome or PositionGreeting has another protocol version, only that version is read.
/// Accepts a Position whose numbers are not finite, so that the master can report the device. Replaces control
/// characters in texts by '?', because these texts are printed.
[[nodiscard]] Message decode(std::span<const std::uint8_t> typeAndPayload);

}  // namespace haptic_bridge
