// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace lockstep {

/// What a process waits for: for a person, and for the event `waiting` (docs/events.md).
struct Wait {
    std::string text;  // "frame 30 waits for rank 2 (tile r1c2) on node02"
    int by = 0;        // rank of the waiting process
    std::uint64_t frame = 0;
    std::vector<int> ranks;  // that have not arrived
    std::string names;       // of these ranks, separated by commas; the master's own work if there are none
};

/// Makes sure that no wait is silent and none is for ever.
///
/// A thread of its own looks on while the main thread is inside a call that may block. After a while it says who is
/// waited for; after the limit it says so once more and ends this process, which makes mpirun end the job. Until
/// startUpIsOver() it has more patience: shaders compile and sand settles before the first frame.
///
/// The master is the first to speak and the first to end the job, because it alone knows who is missing; a rank waits
/// longer, for the case that it is the master that has stopped.
class Watchdog {
public:
    enum class Role { master, firstRank, otherRank };

    /// `describe` names what is waited for; it runs on the watchdog's thread and must only read atomics. Of the ranks
    /// only the first speaks. `lastWords` runs there too, with the line that was said, before the process ends: it may
    /// write to disk, and nothing that the main thread changes may be in it.
    Watchdog(std::function<Wait()> describe, double limitSeconds, Role role,
             std::function<void(const std::string&)> lastWords = {});
    ~Watchdog();
    Watchdog(const Watchdog&) = delete;
    Watchdog& operator=(const Watchdog&) = delete;

    /// From now on until disarm(), time counts. A new arm() starts afresh.
    void arm();
    void disarm();
    void startUpIsOver() { startingUp_ = false; }
    /// Of a start that replays a journal: it speaks as ever, and has more patience still.
    void setPatient(bool patient) { patient_ = patient; }

private:
    void look();

    std::function<Wait()> describe_;
    double limit_;
    Role role_;
    std::function<void(const std::string&)> lastWords_;
    std::atomic<bool> startingUp_{true}, patient_{false};
    std::atomic<std::int64_t> armedAt_{0};  // [ns], 0 when nobody waits
    std::mutex mutex_;
    std::condition_variable stop_;
    bool stopping_ = false;
    std::thread thread_;
};

/// Arms a watchdog for the length of a scope.
class Watched {
public:
    explicit Watched(Watchdog& watchdog) : watchdog_(watchdog) { watchdog_.arm(); }
    ~Watched() { watchdog_.disarm(); }
    Watched(const Watched&) = delete;
    Watched& operator=(const Watched&) = delete;

private:
    Watchdog& watchdog_;
};

}  // namespace lockstep
