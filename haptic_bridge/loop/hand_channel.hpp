// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <cstdint>

#include "base/triple_buffer.hpp"
#include "haptic_bridge/loop/haptic_tick.hpp"
#include "haptic_bridge/loop/tick_recorder.hpp"

namespace haptic_bridge {

/// What the force thread shares with the sand's, without locks.
struct HandChannel {
    boost::lockfree::spsc_queue<HandSample, boost::lockfree::capacity<8192>> samples;  // force thread to sand
    std::atomic<std::uint64_t> overflow{0};  // samples that found the queue full
    base::TripleBuffer<FeltSand> surface;    // sand to force thread
    std::atomic<bool> moving{false};         // the hand's recording runs; it rests while nobody is linked
    std::atomic<std::uint32_t> sitting{0};   // counts the links: the hand begins anew with each
    TickRecorder* recorder = nullptr;        // of every tick, when somebody wants them

    // For the thread that ticks.
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
