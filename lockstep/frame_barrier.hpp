// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lockstep/arrival.hpp"
#include "lockstep/backoff.hpp"
#include "lockstep/cluster.hpp"
#include "lockstep/frame_message.hpp"
#include "lockstep/watchdog.hpp"

namespace lockstep {

/// What the master found when all had arrived.
enum class Verdict : std::uint8_t {
    equal,
    otherSand,  // state hashes differ: findDivergence() tells where
    otherView,  // the sand is equal, but not what some rank sees it by
    nonsense    // some rank has sent what is no arrival at this frame: FrameBarrier::nonsense()
};

/// How a frame begins and ends on every rank: one message from the master to all, and the barrier before the swap,
/// which is also the proof that all replicas are equal.
///
/// Every rank sends its Arrival, state hash and all, to the master by itself; the master compares and tells the
/// verdict. All of it goes point to point, and the master polls: inside a broadcast or an allreduce of MPI a rank that
/// has stopped cannot be told from those that wait for it, and would take the master with it. All waits use Backoff,
/// so that a waiting rank leaves its core to ranks that draw. Main thread only.
class FrameBarrier {
public:
    /// Frame messages up to this size travel whole; longer ones send their rest behind [byte].
    static constexpr std::size_t kOneMessage = 1024;

    /// Who is missing when a wait has run into its limit (-1: nobody in particular), and the line that was said of it.
    using LastWords = std::function<void(int rank, const std::string& line)>;

    /// `names` is how each rank is spoken of, by rank; only the master needs it. A frame that takes longer than
    /// `limitSeconds` ends the job, at the master after `lastWords`, which is called on the watchdog's thread. Ends the
    /// cluster's own start-up watch.
    FrameBarrier(const Cluster& cluster, std::vector<std::string> names, double limitSeconds, LastWords lastWords = {});
    ~FrameBarrier();

    /// Collective: begins a frame. The master gives the message; everyone gets it. Sets `bytes` to its length.
    [[nodiscard]] FrameMessage begin(FrameMessage fromMaster, std::size_t& bytes);

    /// Collective: comes to the barrier of the frame; returns when all have, with whether all hashes are equal. The
    /// master says when it will begin the next frame at the earliest [ns of its clock]: the ranks sleep until then.
    [[nodiscard]] Verdict meet(const Arrival& mine, std::int64_t nextFrame = 0);

    /// At the master: what the ranks said at the last barrier, by rank; its own first.
    [[nodiscard]] const std::vector<Arrival>& arrivals() const { return arrivals_; }

    /// At the master: who sent nonsense to the last barrier, a line each with the rank's name.
    struct Nonsense {
        int rank = 0;
        std::string line;
    };
    [[nodiscard]] const std::vector<Nonsense>& nonsense() const { return nonsense_; }
    /// For a drill: this rank comes to the next barrier with random bytes.
    void garble() { garbles_ = true; }

    /// Collective among those concerned: the bytes of rank `from` to each of `to`, who get them; others get nothing
    /// and may leave it out. Whom the master waits for is named, as at the barrier.
    [[nodiscard]] base::Bytes pass(int from, const std::vector<int>& to, const base::Bytes& bytes);
    /// Collective: everyone's bytes at the master, by rank; others get nothing. Named likewise.
    [[nodiscard]] std::vector<base::Bytes> collect(const base::Bytes& mine);
    /// Collective: the master's bytes to everyone. Named likewise.
    [[nodiscard]] base::Bytes tellAll(const base::Bytes& fromMaster);

    [[nodiscard]] const Cluster& cluster() const { return cluster_; }
    /// What the master is at while it waits for no rank, such as "its journal"; text that lives on.
    void busyWith(const char* what) { busyWith_ = what; }
    static constexpr const char* kPictures = "pictures";

    /// Watches waits outside the frame loop too, such as for reports and pictures.
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
    std::vector<Arrival> arrivals_;
    std::vector<Nonsense> nonsense_;
    std::vector<int> ranks_;                        // all but the master, at the master
    std::unique_ptr<std::atomic<bool>[]> missing_;  // by rank; read by the watchdog's thread
    std::atomic<const char*> busyWith_{kPictures};
    std::atomic<std::uint64_t> frame_{0};
    bool garbles_ = false;
    std::int64_t quietUntil_ = 0;  // [ns], at a rank: no frame begins before
    std::unique_ptr<Watchdog> watchdog_;
};

/// For a scope the master is busy with something of its own that may hang; watched, and named as any wait.
class Busy {
public:
    Busy(FrameBarrier& barrier, const char* what) : barrier_(barrier), watched_(barrier.watchdog()) {
        barrier_.busyWith(what);
    }
    ~Busy() { barrier_.busyWith(FrameBarrier::kPictures); }
    Busy(const Busy&) = delete;
    Busy& operator=(const Busy&) = delete;

private:
    FrameBarrier& barrier_;
    Watched watched_;
};

}  // namespace lockstep
