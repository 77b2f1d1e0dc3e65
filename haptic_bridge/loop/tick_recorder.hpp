// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "haptic_bridge/loop/haptic_tick.hpp"
#include "haptic_bridge/loop/tick_file.hpp"
#include "haptic_bridge/loop/tick_track.hpp"

namespace haptic_bridge {

/// Writes every tick of a hand to a CSV file, and cuts the tick track into pieces for the master's journal.
///
/// Ticks come from the thread that makes them through a queue without locks; a thread of the recorder's own formats and
/// writes. A disk that refuses is told in one line: what stands in the file then ends with a whole row, and the track
/// goes on. In real time a tick that finds the queue full is left out and told; the fast pace waits instead.
class TickRecorder {
public:
    struct Options {
        std::string file;
        bool wait = false;                            // the fast pace
        std::function<void(const std::string&)> log;  // one line for a person; on the recorder's thread
    };
    /// Throws base::InputError when the file cannot be made. `hand` outlives this.
    TickRecorder(Options options, const HapticTick& hand);
    ~TickRecorder();
    TickRecorder(const TickRecorder&) = delete;
    TickRecorder& operator=(const TickRecorder&) = delete;

    // The ticking thread:
    /// A link begins: the hand has forgotten what was before.
    void begin();
    /// The hand has ticked.
    void add();

    // The streaming thread:
    /// What the master has not got yet.
    [[nodiscard]] std::vector<base::Bytes> takePieces();
    /// Returns when all that was added before has become pieces, or after 0.3 s; the fast pace waits up to 30 s.
    void flush();

private:
    struct Entry {
        bool begins = false;
        Tick tick;
        TickInput input;
    };
    void push(const Entry& entry);
    void run();
    void take(const Entry& entry);
    void endPiece();

    Options options_;
    const HapticTick& hand_;
    const TrackHeader header_;
    boost::lockfree::spsc_queue<Entry, boost::lockfree::capacity<8192>> queue_;
    std::atomic<std::uint64_t> added_{0}, done_{0}, lost_{0};
    std::atomic<bool> stopping_{false};

    std::mutex mutex_;
    std::vector<base::Bytes> pieces_;

    // The recorder's thread.
    TickFile file_;
    TrackPiece piece_;
    std::uint64_t toldLost_ = 0;
    std::thread thread_;
};

}  // namespace haptic_bridge
