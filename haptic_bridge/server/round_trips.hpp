// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <random>

#include "base/live_histogram.hpp"
#include "haptic_bridge/link/protocol.hpp"

namespace haptic_bridge {

/// Times of the timing tests. They are random, but from a seed, so that a session can be repeated exactly.
struct TimingTests {
    double perSecond = 4;  // mean number of tests per second
    double after = 0;      // [s] of a link before the first test, because a wall's first frames compile shaders
    std::uint32_t seed = 7;
};

/// Timing tests of one link, and half of their round-trip times. It reads no clock: the caller passes the time [ns] of
/// one clock.
class RoundTrips {
public:
    explicit RoundTrips(const TimingTests& tests) : perSecond_(tests.perSecond), random_(tests.seed) {}

    /// Returns the pause before the next test [s].
    [[nodiscard]] double pause();
    /// Returns the next test, which is sent now. On the wire it is as long as a message of `bytes` bytes.
    [[nodiscard]] TimingTest next(std::size_t bytes, std::int64_t nowNs);
    /// Takes an answer. Ignores it if its test is unknown or forgotten.
    void echoed(const TimingEcho& echo, std::int64_t nowNs);
    /// Fills in the round-trip times of `report`.
    void fill(Report& report) const;

    static constexpr std::size_t kMostOut = 64;  // tests without their last answer; beyond that the oldest is forgotten

private:
    struct Out {
        std::int64_t sentNs = 0;
        bool received = false;
    };
    double perSecond_;
    std::minstd_rand random_;
    std::uint32_t last_ = 0;
    std::map<std::uint32_t, Out> out_;       // tests without their last answer, by id
    base::LiveHistogram toWall_, toMaster_;  // half of each round trip
};

}  // namespace haptic_bridge
