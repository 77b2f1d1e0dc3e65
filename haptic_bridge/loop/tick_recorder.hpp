// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "haptic_bridge/loop/first_failure.hpp"
#include "haptic_bridge/loop/haptic_tick.hpp"
#include "haptic_bridge/loop/tick_file.hpp"
#include "haptic_bridge/loop/tick_track.hpp"

namespace haptic_bridge {

/// Writes every tick of a hand to a CSV file, and cuts the tick track into pieces for the master's journal.
///
/// The thread that runs the ticks puts them into a queue without locks. The recorder's own thread formats and writes
/// them. If the disk refuses a write, the file ends with a whole row and one line is logged; the tick track continues.
/// If the queue is full, a tick in real time is left out, and the loss is logged. Under the fast pace the thread waits
/// instead.
class TickRecorder {
public:
    struct Options {
        std::string file;
        bool wait = false;                            // true under the fast pace: wait when the queue is full
        std::function<void(const std::string&)> log;  // gets one line for the user, on the recorder's thread
    };
    /// Throws base::InputError if the file cannot be created. `hand` and `failure` must outlive this object. `failure`
    /// gets an exception of the recorder's thread.
    TickRecorder(Options options, const HapticTick& hand, FirstFailure& failure);
    ~TickRecorder();
    TickRecorder(const TickRecorder&) = delete;
    TickRecorder& operator=(const TickRecorder&) = delete;

    // For the thread that runs the ticks.
    /// Begins a new sitting, because a link begins. The hand has forgotten its earlier ticks.
    void begin();
    /// Records the last tick of the hand.
    void add();

    // For the streaming thread.
    /// Returns the pieces that the master has not received yet. Some 10 s of a hand can wait; later pieces are dropped.
    [[nodiscard]] std::vector<base::Bytes> takePieces();
    /// Waits until everything that was added before is in pieces, but at most 0.3 s; under the fast pace at most 30 s.
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
    std::size_t pieceBytes_ = 0;  // [byte] of the messages with these pieces, without the header of the sitting

    // For the recorder's own thread.
    TickFile file_;
    TrackPiece piece_;
    std::uint64_t printedLost_ = 0;
    std::thread thread_;
};

}  // namespace haptic_bridge
