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

/// What came from a tracker, for the summary.
struct Counters {
    std::uint64_t packets = 0;    // all that arrived; 0 for a trace
    std::uint64_t refused = 0;    // malformed or absurd: left out
    std::uint64_t old = 0;        // doubled or overtaken: left out
    std::uint64_t absent = 0;     // in order, but the tracker does not see the head
    std::uint64_t timesLost = 0;  // no pose for half a second
    std::uint64_t outside = 0;    // poses not in front of every screen: left out
    std::uint64_t strangers = 0;  // from an address that is not the tracker's: left out
    friend bool operator==(const Counters&, const Counters&) = default;
};

/// Something that knows where the head is. One thread; no member blocks, waits or throws.
class HeadTracker {
public:
    HeadTracker() = default;
    virtual ~HeadTracker() = default;
    HeadTracker(const HeadTracker&) = delete;
    HeadTracker& operator=(const HeadTracker&) = delete;

    /// The newest pose, the last one held when none is new; nothing before the first. `seconds` is the session's time,
    /// which only a trace reads: with the same times it gives the same poses.
    [[nodiscard]] virtual std::optional<Pose> newest(double seconds) = 0;
    [[nodiscard]] virtual Counters counters() const { return {}; }
    /// Where it listens; 0 for one that does not.
    [[nodiscard]] virtual std::uint16_t port() const { return 0; }
};

/// Opens what the source names; nothing for none. `restingEye` is the fixed viewer's [m].
/// Throws base::InputError: a broken trace with file, line and value; a port that is taken.
[[nodiscard]] std::unique_ptr<HeadTracker> openTracker(const Source& source, glm::dvec3 restingEye, Say say,
                                                       Clock clock = host::monotonicNs);

}  // namespace tracking
