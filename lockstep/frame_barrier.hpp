// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "lockstep/cluster.hpp"
#include "lockstep/watchdog.hpp"

namespace lockstep {

/// What a rank says when it comes to the barrier. Times are in its own clock, corrected to the master's [ns].
struct Arrival {
    std::uint64_t frame = 0;
    std::int64_t arrived = 0;
    std::int64_t lastSwap = 0;  // when it swapped the frame before; 0 on the first
    std::int64_t drawn = 0;     // how long it drew [ns]
    std::uint64_t stateHash = 0;
};

/// The barrier before a swap, which is also the proof that all replicas are equal.
///
/// Every rank sends its Arrival, state hash and all, to the master by itself; the master compares and broadcasts the
/// verdict. Not an allreduce: a rank that stops inside one cannot be told from those that wait for it. Main thread
/// only.
class FrameBarrier {
public:
    /// `names` is how each rank is spoken of, by rank; only the master needs it. A rank that waits longer than
    /// `limitSeconds` ends the job.
    FrameBarrier(const Cluster& cluster, std::vector<std::string> names, double limitSeconds);
    ~FrameBarrier();

    /// Collective: comes to the barrier of a frame and returns when all have come, with whether all hashes are equal.
    [[nodiscard]] bool meet(const Arrival& mine);

    /// At the master: what the ranks said at the last barrier, by rank; its own first.
    [[nodiscard]] const std::vector<Arrival>& arrivals() const { return arrivals_; }

    /// Watches other waits than the barrier, such as a rank's for the next broadcast.
    [[nodiscard]] Watchdog& watchdog() { return *watchdog_; }

private:
    void collectArrivals(std::uint64_t frame);
    [[nodiscard]] std::string describeWait() const;

    const Cluster& cluster_;
    std::vector<std::string> names_;
    std::vector<Arrival> arrivals_;
    std::vector<MPI_Request> receives_;
    std::unique_ptr<std::atomic<bool>[]> missing_;  // by rank; read by the watchdog's thread
    std::atomic<std::uint64_t> frame_{0};
    std::unique_ptr<Watchdog> watchdog_;
};

}  // namespace lockstep
