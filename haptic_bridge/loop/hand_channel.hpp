// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <cstdint>

#include "base/triple_buffer.hpp"
#include "haptic_bridge/loop/first_failure.hpp"
#include "haptic_bridge/loop/haptic_tick.hpp"
#include "haptic_bridge/loop/tick_recorder.hpp"

namespace haptic_bridge {

/// Data between the thread that runs the ticks of a hand and the thread that makes steps of them.
///
/// In real time these are the force thread and the sand thread. They share the data without locks, so that neither
/// waits for the other. Under the fast pace the sand thread does both, and uses only `recorder` and `failure`.
struct HandChannel {
    // From the force thread to the sand thread.
    boost::lockfree::spsc_queue<HandSample, boost::lockfree::capacity<8192>> samples;  // of 8 s
    std::atomic<std::uint64_t> overflow{0};  // number of samples that were lost because `samples` was full

    // From the sand thread to the force thread.
    base::TripleBuffer<FeltSand> surface;   // latest copy of the sand around the hand
    std::atomic<bool> moving{false};        // whether a master is linked. If not, the hand rests (HapticTick::rest())
    std::atomic<std::uint32_t> sitting{0};  // number of links so far. A change makes the force thread begin a sitting

    TickRecorder* recorder = nullptr;  // recorder of all ticks; null if they are not recorded
    FirstFailure failure;              // first exception of a thread of the server

    // For the thread that runs the ticks.
    /// Begins the ticks of a link. The hand and the recorder forget the earlier ones.
    void beginSitting(HapticTick& hand) const {
        hand.restart();
        if (recorder != nullptr) {
            recorder->begin();
        }
    }
    /// Records the last tick, if there is a recorder.
    void keepTick() const {
        if (recorder != nullptr) {
            recorder->add();
        }
    }
};

}  // namespace haptic_bridge
