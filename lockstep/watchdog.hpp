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

/// Description of a wait. It is printed, and it is reported by the event `waiting` (docs/events.md).
struct Wait {
    std::string text;  // "frame 30 waits for rank 2 (tile r1c2) on node02"
    int by = 0;        // rank of the waiting process
    std::uint64_t frame = 0;
    std::vector<int> ranks;  // ranks that have not arrived
    std::string names;       // names of these ranks, separated by commas; the master's own work if the list is empty
};

/// Throws base::InputError if the environment variable SANDWALL_START_TIMEOUT is set, but is not a number of seconds
/// from 1 to 3600. A watchdog takes 120 s instead.
void requireStartUpLimit();

/// Thread that reports every long wait, and ends the job if a wait reaches its limit.
///
/// The thread watches while the main thread is inside a call that may block. All functions may be called by any thread.
/// After 1 s it prints which ranks are missing. After the limit it prints them again and ends this process, so that
/// mpirun ends the job. Until startUpIsOver() both times are longer, because shaders compile and sand settles before
/// the first frame. The limit is then at least 120 s, or the seconds in the environment variable
/// SANDWALL_START_TIMEOUT.
///
/// The master is the first to print and the first to end the job, because only the master knows which ranks are
/// missing. Other ranks wait some seconds longer, in case the master itself has stopped.
class Watchdog {
public:
    enum class Role { master, firstRank, otherRank };
    /// Returns the role of this rank.
    [[nodiscard]] static Role roleOf(int rank);

    /// `describe` describes the present wait. It runs on the watchdog's thread and must only read atomics.
    /// `limitSeconds` is the limit of a wait [s]. Only the master and the first render rank print.
    ///
    /// `lastWords` also runs on the watchdog's thread, before the process ends, with the line that was printed. It may
    /// write to disk, but it must not read data that the main thread changes.
    Watchdog(std::function<Wait()> describe, double limitSeconds, Role role,
             std::function<void(const std::string&)> lastWords = {});
    ~Watchdog();
    Watchdog(const Watchdog&) = delete;
    Watchdog& operator=(const Watchdog&) = delete;

    /// Begins to measure a wait, which lasts until disarm(). Another arm() begins a new wait. A wait that ends while
    /// the watchdog describes it is neither printed nor ends the job.
    void arm();
    void disarm();
    /// Changes the role. A process learns its rank for certain only from MPI_Init.
    void setRole(Role role) { role_ = role; }
    void startUpIsOver() { startingUp_ = false; }
    /// Sets the limit of a wait [s].
    void setLimit(double seconds) { limit_ = seconds; }
    /// Sets whether the limit is an hour. A start that replays a journal needs this. The watchdog prints as usual
    /// meanwhile.
    void setPatient(bool patient) { patient_ = patient; }

private:
    void look();

    std::function<Wait()> describe_;
    std::atomic<double> limit_;
    std::atomic<Role> role_;
    std::function<void(const std::string&)> lastWords_;
    std::atomic<bool> startingUp_{true}, patient_{false};
    std::atomic<std::int64_t> armedAt_{0};  // [ns]; 0 while no wait is measured
    std::mutex mutex_;
    std::condition_variable stop_;
    bool stopping_ = false;
    std::thread thread_;
};

/// Scope in which a watchdog is armed.
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
