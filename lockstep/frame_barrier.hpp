// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lockstep/arrival.hpp"
#include "lockstep/backoff.hpp"
#include "lockstep/cluster.hpp"
#include "lockstep/frame_message.hpp"
#include "lockstep/watchdog.hpp"

namespace lockstep {

/// Result of the master's comparison when all ranks have arrived.
enum class Verdict : std::uint8_t {
    equal,      // all hashes are equal
    otherSand,  // state hashes or movements differ; findDivergence() finds the ranks and the place
    otherView,  // the sand is equal, but a rank drew another view or another wall
    nonsense    // a rank sent bytes that are not an arrival at this frame; nonsense() names it
};

/// Beginning and end of every frame, on every rank.
///
/// A frame begins with one message from the master to all ranks. It ends at the barrier, before the swap. The barrier
/// also proves that all replicas are equal. Each rank sends its Arrival with its hashes, the master compares the
/// hashes, and every rank gets the verdict.
///
/// All messages are point-to-point, and the master polls for them. Inside a broadcast or an allreduce of MPI, a rank
/// that has stopped looks the same as the ranks that wait for it. The master would hang there, too.
///
/// All waits for messages use Backoff, so that a waiting rank leaves its core to the ranks that draw. Main thread only.
class FrameBarrier {
public:
    /// Largest size of the first MPI message of a frame [byte]. It holds the frame message's length, in 4 bytes, and
    /// the frame message. The rest of a longer frame message follows in a second MPI message.
    static constexpr std::size_t kOneMessage = 1024;

    /// Called when a wait has reached its limit. `rank` is the first missing rank, or -1 if no rank is missing. `line`
    /// is the line that was printed.
    using LastWords = std::function<void(int rank, const std::string& line)>;

    /// `names` are the names of the ranks in messages, in order of rank; only the master needs them. A wait longer than
    /// `limitSeconds` [s] ends the job; until the end of the first barrier it is at least 120 s. The master first calls
    /// `lastWords`, on the watchdog's thread. Ends the start-up watch of `cluster`, and watches from now on. The
    /// destructor begins the watch of the end.
    FrameBarrier(const Cluster& cluster, std::vector<std::string> names, double limitSeconds, LastWords lastWords = {});
    ~FrameBarrier();

    /// Begins a frame: sends the master's message to all ranks, and returns it on each rank. Sets `bytes` to its
    /// encoded length [byte]. Collective; only the master's argument `fromMaster` counts.
    [[nodiscard]] FrameMessage begin(FrameMessage fromMaster, std::size_t& bytes);

    /// Waits at the barrier of the frame until all ranks have arrived. Returns the verdict on each rank. Collective.
    ///
    /// `nextFrame` is the earliest time at which the next frame will begin [ns], on the master's clock. The other ranks
    /// sleep until then when they call begin(). Only the master's argument counts.
    [[nodiscard]] Verdict meet(const Arrival& mine, std::int64_t nextFrame = 0);

    /// Makes all further arrivals carry a PointerReport. Collective: every rank calls it before the first frame.
    void carryPointers();
    /// Sets the report that this rank sends with its further arrivals. Needs carryPointers().
    void setPointer(const haptic_bridge::PointerReport& report) { pointer_ = report; }
    /// Returns the reports at the last barrier in order of rank; that of the master is empty. Empty on other ranks and
    /// without carryPointers().
    [[nodiscard]] const std::vector<haptic_bridge::PointerReport>& pointers() const { return pointers_; }

    /// Returns the earliest time at which the next frame begins [ns, this rank's clock]. begin() sleeps until then.
    [[nodiscard]] std::int64_t quietUntil() const { return quietUntil_; }

    /// Returns the arrivals at the last barrier in order of rank, the master's own first. Empty on other ranks.
    [[nodiscard]] const std::vector<Arrival>& arrivals() const { return arrivals_; }

    /// A rank that sent something other than an arrival.
    struct Nonsense {
        int rank = 0;
        std::string line;  // with frame, the rank's name and what it sent, to be printed
    };
    /// Returns the ranks that sent nonsense to the last barrier. Empty on other ranks than the master.
    [[nodiscard]] const std::vector<Nonsense>& nonsense() const { return nonsense_; }
    /// Drill: makes this rank send random bytes to the next barrier.
    void garble() { garbles_ = true; }

    // The master may wait in each of the next three functions. If it waits too long, the watchdog names the missing
    // ranks.

    /// Sends the bytes of rank `from` to the ranks `to`. Returns them on the ranks `to`, and an empty list on all
    /// others. Collective for `from` and `to`; other ranks need not call it.
    [[nodiscard]] base::Bytes pass(int from, const std::vector<int>& to, const base::Bytes& bytes);
    /// Returns the bytes `mine` of all ranks at the master, in order of rank; an empty list on other ranks. Collective.
    [[nodiscard]] std::vector<base::Bytes> collect(const base::Bytes& mine);
    /// Returns the master's argument `fromMaster` on all ranks. Collective.
    [[nodiscard]] base::Bytes broadcast(const base::Bytes& fromMaster);

    [[nodiscard]] const Cluster& cluster() const { return cluster_; }
    /// Sets what the watchdog names while the master waits for no rank, such as "its journal". `what` must stay valid.
    void busyWith(const char* what) { busyWith_ = what; }
    static constexpr const char* kOwnWork = "the master";  // named by the watchdog before the first call

    /// Notes that the master waits for a message of this rank outside this class, or no longer.
    void setMissing(int rank, bool missing) { missing_[static_cast<std::size_t>(rank)] = missing; }

    /// Sets for how long this rank may wait for the others after the last frame [s]; limitSeconds at first. A render
    /// rank waits for the master to write the pictures of all ranks.
    void setEndLimit(double seconds) { endLimit_ = seconds; }

    /// Returns the watchdog. It also watches waits outside this class, such as for reports and pictures.
    [[nodiscard]] Watchdog& watchdog() { return *watchdog_; }

private:
    void sendToAll(const void* data, std::size_t bytes, int tag);
    void receiveFromMaster(void* data, std::size_t bytes, int tag);
    void await(std::span<MPI_Request> requests, std::span<const int> ranks, Backoff backoff,
               std::vector<int>* lengths = nullptr);
    [[nodiscard]] Backoff backoffFor(std::span<const int> ranks) const;
    void ring(std::span<const int> ranks) const;
    void receiveArrivals(std::uint64_t frame);
    void sendArrival(const Arrival& mine);
    [[nodiscard]] Wait describeWait() const;
    [[nodiscard]] int firstMissing() const;

    const Cluster& cluster_;
    std::vector<std::string> names_;
    double endLimit_;  // [s]
    std::vector<Arrival> arrivals_;
    std::optional<haptic_bridge::PointerReport> pointer_;  // of this rank; nullopt: arrivals carry no report
    std::vector<haptic_bridge::PointerReport> pointers_;   // of all ranks, at the master
    std::vector<Nonsense> nonsense_;
    std::vector<int> ranks_;                        // all render ranks; empty except at the master
    std::unique_ptr<std::atomic<bool>[]> missing_;  // by rank, also read by the watchdog's thread
    std::atomic<const char*> busyWith_{kOwnWork};
    std::atomic<std::uint64_t> frame_{0};
    bool garbles_ = false;
    std::int64_t quietUntil_ = 0;  // [ns], at a render rank: earliest begin of the next frame
    std::unique_ptr<Watchdog> watchdog_;
};

/// Scope in which the master does work of its own that may hang. The watchdog watches it, and names it as `what`.
class Busy {
public:
    Busy(FrameBarrier& barrier, const char* what) : barrier_(barrier), watched_(barrier.watchdog()) {
        barrier_.busyWith(what);
    }
    ~Busy() { barrier_.busyWith(FrameBarrier::kOwnWork); }
    Busy(const Busy&) = delete;
    Busy& operator=(const Busy&) = delete;

private:
    FrameBarrier& barrier_;
    Watched watched_;
};

}  // namespace lockstep
