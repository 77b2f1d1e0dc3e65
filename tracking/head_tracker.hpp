// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "host/clock.hpp"
#include "tracking/pose.hpp"
#include "tracking/presence.hpp"
#include "tracking/source.hpp"

namespace tracking {

/// Counts of a tracker's packets and poses. The summary prints them.
struct Counters {
    std::uint64_t packets = 0;    // all packets that arrived; 0 for a trace
    std::uint64_t refused = 0;    // malformed or implausible packets, left out
    std::uint64_t old = 0;        // duplicate or overtaken packets, left out
    std::uint64_t absent = 0;     // packets in order in which the tracker does not see the head
    std::uint64_t timesLost = 0;  // times that no pose came for half a second
    std::uint64_t outside = 0;    // poses that are not in front of every screen, left out
    std::uint64_t strangers = 0;  // packets from another address than the tracker's, left out
    /// The keys in `head_tracking` of summary.json.
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("packets", it.packets);
        visit("refused", it.refused);
        visit("old", it.old);
        visit("absent", it.absent);
        visit("lost", it.timesLost);
        visit("outside", it.outside);
        visit("strangers", it.strangers);
    }
    friend bool operator==(const Counters&, const Counters&) = default;
};

/// Source of the head's pose. Used by one thread. No member blocks, waits or throws.
class HeadTracker {
public:
    HeadTracker() = default;
    virtual ~HeadTracker() = default;
    HeadTracker(const HeadTracker&) = delete;
    HeadTracker& operator=(const HeadTracker&) = delete;

    /// Returns the newest pose. If none has arrived since the last call, returns the last pose; before the first pose,
    /// returns nullopt. `seconds` is the session's time. Only a trace uses it: equal times give equal poses.
    [[nodiscard]] virtual std::optional<Pose> newest(double seconds) = 0;
    [[nodiscard]] virtual Counters counters() const { return {}; }
    /// Returns the port that the tracker listens on, or 0.
    [[nodiscard]] virtual std::uint16_t port() const { return 0; }
};

/// Opens the tracker of `source`, or returns null for the source "none". `restingEye` is the fixed viewer's eye [m].
/// Throws base::InputError for a broken trace, with file, line and value, and for a port in use.
[[nodiscard]] std::unique_ptr<HeadTracker> openTracker(const Source& source, glm::dvec3 restingEye, Print print,
                                                       Clock clock = host::monotonicNs);

}  // namespace tracking
