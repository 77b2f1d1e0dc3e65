// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <random>

#include "base/live_histogram.hpp"
#include "haptic_bridge/link/protocol.hpp"

namespace haptic_bridge {

/// At which times a master is sent timing tests: at random, from a seed, because nothing in a session should differ by
/// chance.
struct TimingTests {
    double perSecond = 4;  // mean
    double after = 0;      // [s] from when the server numbers the steps: a wall's first frames compile shaders
    std::uint32_t seed = 7;
};

/// The timing tests of one link, and half of their way there and back. Pure: calls bring the time [ns, one clock].
class RoundTrips {
public:
    explicit RoundTrips(const TimingTests& tests) : perSecond_(tests.perSecond), random_(tests.seed) {}

    /// Returns the pause before the next test [s].
    [[nodiscard]] double pause();
    /// The next test, which is sent now. On the wire it is as long as a message of `bytes`.
    [[nodiscard]] TimingTest next(std::size_t bytes, std::int64_t nowNs);
    /// An answer has come. One to a test that is not known any more is ignored.
    void echoed(const TimingEcho& echo, std::int64_t nowNs);
    void fill(Report& report) const;

    static constexpr std::size_t kMostOut = 64;  // tests without their last answer; of more the oldest is forgotten

private:
    struct Out {
        std::int64_t sentNs = 0;
        bool received = false;
    };
    double perSecond_;
    std::minstd_rand random_;
    std::uint32_t last_ = 0;
    std::map<std::uint32_t, Out> out_;       // by id
    base::LiveHistogram toWall_, toMaster_;  // half of the round trips
};

}  // namespace haptic_bridge
