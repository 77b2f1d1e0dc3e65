// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "base/field_forms.hpp"
#include "haptic_bridge/hand/guard_counts.hpp"
#include "haptic_bridge/hand/hand_ticks.hpp"
#include "haptic_bridge/link/greetings.hpp"

/// Measurements of a haptic server. protocol.hpp lists all messages.
namespace haptic_bridge {

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
constexpr auto valuesOf(Withheld) {
    using enum Withheld;
    return std::array{base::Named{wall, "wall"}, base::Named{disk, "disk"}, base::Named{pause, "pause"},
                      base::Named{start, "start"}};
}
/// Number of withheld steps with each cause, in the order of valuesOf(Withheld).
using WithheldCounts = std::array<std::uint64_t, valuesOf(Withheld{}).size()>;
[[nodiscard]] std::uint64_t inAll(const WithheldCounts& counts);

/// Result of the audit of the server's whole replica, which hashes its sand again from memory.
enum class Audited : std::uint8_t {
    no,      // not audited
    agreed,  // the memory has the state hash that the server has sent
    differed
};
constexpr auto valuesOf(Audited) {
    using enum Audited;
    return std::array{base::Named{no, "no"}, base::Named{agreed, "agreed"}, base::Named{differed, "differed"}};
}
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
    std::array<std::uint64_t, kGuards> guards{};  // ticks in which each guard acted, in the order of valuesOf(Guard)
    RefusalCounts refused{};                      // connections that the server refused
    std::uint64_t handTicks = 0;                  // ticks while a master was linked, under both paces
    std::uint64_t feltTicks = 0;                  // of these, ticks that pushed a force above 0
    std::uint64_t faultedTicks = 0;               // of these, ticks in which a fault acted (kFaults)
    std::uint64_t handSeconds = 0;                // seconds with such a tick
    std::uint64_t faultedSeconds = 0;             // of these, seconds with a fault
    OutcomeCounts asked{};                        // ticks in which the law asks for force, by what the hand had of it
    bool literal = false;                         // the server runs with --guards literal
    std::uint64_t deviceLosses = 0;               // times that the device stopped to answer
    bool deviceAway = false;                      // the device does not answer now
    bool arm = false;                             // the device has a body that forces push
    Audited audited = Audited::no;                // agreed or differed only in the last report of a link
    /// The order of the bytes. The names are the keys in `haptic` of summary.json (master/measure/summary.hpp).
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("haptic_period_us/p50", it.hapticPeriodUsP50);
        visit("haptic_period_us/p99", it.hapticPeriodUsP99);
        visit("haptic_period_us/max", it.hapticPeriodUsMax);
        visit("force_us/p50", it.forceUsP50);
        visit("force_us/p99", it.forceUsP99);
        visit("half_round_trip_ms/mean", it.toWall.msMean);
        visit("half_round_trip_ms/stddev", it.toWall.msStddev);
        visit("half_round_trip_ms/p50", it.toWall.msP50);
        visit("half_round_trip_ms/p99", it.toWall.msP99);
        visit("half_round_trip_to_master_ms/mean", it.toMaster.msMean);
        visit("half_round_trip_to_master_ms/stddev", it.toMaster.msStddev);
        visit("half_round_trip_to_master_ms/p50", it.toMaster.msP50);
        visit("half_round_trip_to_master_ms/p99", it.toMaster.msP99);
        visit("step_message_bytes", it.stepBytesMean);
        visit("steps", it.steps);
        visit("samples_dropped", it.samplesDropped);
        visit("ticks", it.ticks);
        visit("ticks_missed", it.ticksMissed);
        visit("half_round_trip_ms/count", it.toWall.count);
        visit("half_round_trip_to_master_ms/count", it.toMaster.count);
        visit("hand_ticks", it.handTicks);
        visit("felt_ticks", it.feltTicks);
        visit("faulted_ticks", it.faultedTicks);
        visit("hand_seconds", it.handSeconds);
        visit("faulted_seconds", it.faultedSeconds);
        visit("asked_ticks", base::byName<ForceOutcome>(it.asked));
        visit("steps_withheld_by", base::byName<Withheld>(it.stepsWithheld));
        visit("guarded_ticks", base::byName<Guard>(it.guards));
        visit("refused/connections", base::byName<RefusalCode>(it.refused));
        visit("literal", it.literal);
        visit("device_losses", it.deviceLosses);
        visit("device_away", it.deviceAway);
        visit("arm", it.arm);
        visit("audited", it.audited);
    }
    friend bool operator==(const Report&, const Report&) = default;
};
}  // namespace haptic_bridge
