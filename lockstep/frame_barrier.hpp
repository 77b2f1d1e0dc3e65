// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "lockstep/cluster.hpp"
#include "lockstep/frame_message.hpp"
#include "lockstep/watchdog.hpp"

namespace lockstep {

/// What a rank says when it comes to the barrier. Times are in its own clock, corrected to the master's [ns].
struct Arrival {
    std::uint64_t frame = 0;
    std::int64_t arrived = 0;
    std::int64_t lastSwap = 0;  // when it swapped the frame before; 0 on the first
    std::int64_t drawn = 0;     // how long it drew [ns]
    std::uint64_t stateHash = 0;
    std::uint64_t viewHash = 0;  // ViewProof::hash of what this frame was drawn by
    char key = 0;                // pressed in a window of this rank since the frame before; 0 for none
};

/// What the master found when all had arrived.
enum class Verdict : std::uint8_t {
    equal,
    otherSand,  // state hashes differ: findDivergence() tells where
    otherView   // the sand is equal, but not what some rank sees it by
};

/// How a frame begins and ends on every rank: one message from the master to all, and the barrier before the swap,
/// which is also the proof that all replicas are equal.
///
/// Every rank sends its Arrival, state hash and all, to the master by itself; the master compares and tells the
/// verdict. All of it goes point to point, and the master polls: inside a broadcast or an allreduce of MPI a rank that
/// has stopped cannot be told from those that wait for it, and would take the master with it. All waiting is
/// Patience's, so that who waits leaves the core to who draws. Main thread only.
class FrameBarrier {
public:
    /// Frame messages up to this size travel whole; longer ones send their rest behind [byte].
    static constexpr std::size_t kOneMessage = 1024;

    /// `names` is how each rank is spoken of, by rank; only the master needs it. A frame that takes longer than
    /// `limitSeconds` ends the job. Ends the cluster's own start-up watch.
    FrameBarrier(const Cluster& cluster, std::vector<std::string> names, double limitSeconds);
    ~FrameBarrier();

    /// Collective: begins a frame. The master gives the message; everyone gets it. Sets `bytes` to its length.
    [[nodiscard]] FrameMessage begin(const FrameMessage& fromMaster, std::size_t& bytes);

    /// Collective: comes to the barrier of the frame; returns when all have, with whether all hashes are equal. The
    /// master says when it will begin the next frame at the earliest [ns of its clock]: the ranks sleep until then.
    [[nodiscard]] Verdict meet(const Arrival& mine, std::int64_t nextFrame = 0);

    /// At the master: what the ranks said at the last barrier, by rank; its own first.
    [[nodiscard]] const std::vector<Arrival>& arrivals() const { return arrivals_; }

    /// Watches waits outside the frame loop too, such as for reports and pictures.
    [[nodiscard]] Watchdog& watchdog() { return *watchdog_; }

private:
    void sendToAll(const void* data, std::size_t bytes, int tag);
    void receiveFromMaster(void* data, std::size_t bytes, int tag) const;
    void awaitEach();
    [[nodiscard]] std::string describeWait() const;

    const Cluster& cluster_;
    std::vector<std::string> names_;
    std::vector<Arrival> arrivals_;
    std::vector<MPI_Request> requests_;             // one per rank, at the master
    std::unique_ptr<std::atomic<bool>[]> missing_;  // by rank; read by the watchdog's thread
    std::atomic<std::uint64_t> frame_{0};
    std::int64_t quietUntil_ = 0;  // [ns], at a rank: no frame begins before
    std::unique_ptr<Watchdog> watchdog_;
};

}  // namespace lockstep
