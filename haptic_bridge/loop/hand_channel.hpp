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

/// Data that the force thread and the sand thread share without locks, so that neither waits for the other. The queue
/// holds the samples of 8 s.
struct HandChannel {
    boost::lockfree::spsc_queue<HandSample, boost::lockfree::capacity<8192>> samples;  // force thread to sand thread
    std::atomic<std::uint64_t> overflow{0};  // samples that were lost because the queue was full
    base::TripleBuffer<FeltSand> surface;    // from sand thread to force thread
    std::atomic<bool> moving{false};         // whether a master is linked; without one the hand rests
    std::atomic<std::uint32_t> sitting{0};   // number of links so far; with each, the hand forgets its earlier ticks
    TickRecorder* recorder = nullptr;        // recorder of all ticks; null if they are not recorded
    FirstFailure failure;                    // of the threads

    // For the thread that runs the ticks.
    void beginSitting(HapticTick& hand) const {
        hand.restart();
        if (recorder != nullptr) {
            recorder->begin();
        }
    }
    void keepTick() const {
        if (recorder != nullptr) {
            recorder->add();
        }
    }
};

}  // namespace haptic_bridge
