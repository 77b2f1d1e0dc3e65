// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mpi.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "base/byte_stream.hpp"
#include "host/clock.hpp"
#include "lockstep/doorbell.hpp"
#include "lockstep/host_memory.hpp"
#include "lockstep/watchdog.hpp"

namespace lockstep {

inline constexpr int kMaster = 0;
inline constexpr std::uint64_t kMpiPiece = 1 << 30;  // [byte], most in one call of MPI, which counts in int

/// The MPI job of a session. Initialises MPI, ends it in the destructor, and holds one communicator per purpose.
///
/// A watchdog watches each wait of the start and of the end, from MPI_Init to MPI_Finalize. FrameBarrier has a watchdog
/// of its own for the frames in between. At the end each render rank reports to the master from inside MPI_Finalize. So
/// the master can name a rank that hangs before that, such as in its OpenGL driver.
///
/// Only the thread that made the object may call MPI (MPI_THREAD_FUNNELED). If an MPI call fails, Open MPI prints its
/// name and ends the job.
class Cluster {
public:
    Cluster(int* argc, char*** argv);
    ~Cluster();
    Cluster(const Cluster&) = delete;
    Cluster& operator=(const Cluster&) = delete;

    [[nodiscard]] int rank() const { return rank_; }
    [[nodiscard]] int size() const { return size_; }
    [[nodiscard]] int renderRanks() const { return size_ - 1; }
    [[nodiscard]] bool isMaster() const { return rank_ == kMaster; }

    /// Returns the host of each rank and its free memory at the start, in order of rank. Empty on other ranks than the
    /// master.
    [[nodiscard]] const std::vector<RankHost>& hosts() const { return hosts_; }

    [[nodiscard]] MPI_Comm frames() const { return frames_; }      // broadcasts, frame messages and verdicts
    [[nodiscard]] MPI_Comm arrivals() const { return arrivals_; }  // arrivals at the barrier
    [[nodiscard]] MPI_Comm pictures() const { return pictures_; }  // screenshots

    /// Returns the bells of this host's ranks. The sender of a message rings the receiver's bell after the message.
    [[nodiscard]] const HostBells& bells() const { return *bells_; }

    /// Returns the master's argument `fromMaster` on the render ranks, and no bytes at the master, which has them. The
    /// limit of the start counts from each hundredth of the bytes. Calls `sent` with the part that was sent, 0 to 1,
    /// unless it is empty. Collective, before the first frame.
    [[nodiscard]] base::Bytes broadcast(const base::Bytes& fromMaster,
                                        const std::function<void(double)>& sent = {}) const;
    /// Returns the bytes `mine` of all ranks at the master, in order of rank; an empty list on other ranks. Collective.
    [[nodiscard]] std::vector<base::Bytes> gather(const base::Bytes& mine) const { return gather(mine, {}); }

    /// Called at the master when a wait of the start or the end has reached its limit. `rank` is the first missing
    /// rank, or -1 if it is not known. `line` is the line that was printed. Runs on the watchdog's thread.
    using LastWords = std::function<void(int rank, const std::string& line)>;
    /// Sets what the watchdog of the start and the end calls and prints. `names` are the names of the ranks in
    /// messages, in order of rank; an empty list leaves them as they are. Only the master needs this. Any thread.
    void setLastWords(std::vector<std::string> names, LastWords lastWords) const;

    /// Sets whether the start may take an hour, because the ranks wait while the master replays a journal.
    void mayTakeLong(bool may) const;

    /// Called by the master before the broadcast of the session, during a part of its start that knows its progress.
    /// `share` is the part of the work that is done, 0 to 1, never a time. After each hundredth
    /// the wait of all ranks begins again, with the usual limit of the start instead of an hour. `work` names the work
    /// in messages: "the reading of its scene". It must be a literal. The ranks must wait in awaitBroadcast().
    void progress(const char* work, double share) const;
    /// Called by the master when the work of progress() has ended. The ranks then wait up to an hour again, because the
    /// rest of the start cannot tell its progress.
    void progressEnds() const;
    /// Waits at the render ranks until the master has called it, and takes the master's progress meanwhile. Collective,
    /// before the first broadcast().
    void awaitBroadcast() const;

    /// Called by a render rank while it makes its part of the session, before gatherReady(). `share` is the part of
    /// this work that is done, 0 to 1, never a time. After each hundredth the limit of the start counts again. This
    /// holds for this rank, for the master, and for the ranks that are ready and wait.
    void rankProgress(double share) const;
    /// Does the same as gather(), and takes the progress of the render ranks meanwhile. Calls `made` with the mean
    /// of their progress, unless it is empty. Collective, before the first frame.
    [[nodiscard]] std::vector<base::Bytes> gatherReady(const base::Bytes& mine,
                                                       const std::function<void(double)>& made = {}) const;
    /// Returns the master's argument `master` on all ranks. Takes the progress of the other ranks meanwhile.
    /// Collective, after gatherReady().
    [[nodiscard]] bool agree(bool master) const;

    /// Stops the watchdog of the start. FrameBarrier calls this, because it has a watchdog of its own.
    void startUpIsOver() const;
    /// Starts the watchdog of the end, with a limit of `limitSeconds` [s]. FrameBarrier calls this when it ends.
    void endBegins(double limitSeconds) const;

    /// Notes that the master waits for this rank, or no longer, so that the watchdog can name it.
    void setMissing(int rank, bool missing) const;

    /// Ends the whole job at once with the exit status `status`. Used when the ranks cannot be asked to end.
    [[noreturn]] void abort(int status) const;

private:
    /// Message of the master to the render ranks while it prepares the session.
    enum class StartNote : std::uint8_t {
        progress,   // the usual limit of the start counts from now
        quiet,      // the master may be silent for an hour
        broadcast,  // the session comes
        begin,      // agree() returns true
        refuse      // agree() returns false
    };
    void send(StartNote note) const;
    void send(StartNote note, int rank) const;
    /// Waits at the master until all `requests` are done. `ranks` are the ranks at their other ends. Calls `between`
    /// after each look.
    void await(std::span<MPI_Request> requests, std::span<const int> ranks,
               const std::function<void()>& between = {}) const;
    [[nodiscard]] std::vector<base::Bytes> gather(const base::Bytes& mine, const std::function<void()>& between) const;
    void takeRankProgress(const std::function<void(double)>& made) const;
    void farewell() const;
    [[nodiscard]] Wait describeWait() const;
    [[nodiscard]] std::vector<int> missing() const;

    std::atomic<int> rank_{0};  // also read by the watchdog's thread
    int size_ = 1;
    std::unique_ptr<std::atomic<bool>[]> missing_;       // by rank, also read by the watchdog's thread
    std::atomic<int> missingSize_{0};                    // number of entries of missing_
    mutable std::atomic<const char*> phase_;             // named by the watchdog
    mutable std::atomic<const char*> ownWork_{nullptr};  // of the master, for which all ranks wait; null for none
    mutable double progress_ = 0;                        // of ownWork_, or of this rank's own part, 0 to 1
    mutable std::vector<double> rankShares_;             // progress of each rank, at the master
    mutable std::int64_t passedOn_ = 0;                  // time of the last note about progress of ranks [ns]
    mutable std::mutex mutex_;                           // of the two members below
    mutable std::vector<std::string> names_;
    mutable LastWords lastWords_;
    std::unique_ptr<Watchdog> watchdog_;
    /// MPI_Abort needs memory to name the rank. Without any it would end the process with a status of its own, after
    /// which no session goes on. Small enough that malloc() takes it from the heap.
    static constexpr std::size_t kReserve = 1 << 16;  // [byte]
    mutable std::unique_ptr<std::byte[]> reserve_ = std::make_unique<std::byte[]>(kReserve);
    std::vector<RankHost> hosts_;
    std::unique_ptr<HostBells> bells_;
    MPI_Comm frames_ = MPI_COMM_NULL;
    MPI_Comm arrivals_ = MPI_COMM_NULL;
    MPI_Comm pictures_ = MPI_COMM_NULL;
};

/// Asks the kernel to kill this process when its parent process (mpirun, its daemon or the launcher) ends. No process
/// then outlives the job, even if mpirun is killed.
void endWithParent();

[[nodiscard]] std::string hostName();
/// Returns the name of this machine and the id of its last start, "node01/3f2a…". No two machines have the same, also
/// if their names are equal. scripts/launcher/hosts/reachable.py makes the same text.
[[nodiscard]] std::string machineId();
/// Returns the resident memory of this process [byte].
[[nodiscard]] std::int64_t residentBytes();

}  // namespace lockstep
