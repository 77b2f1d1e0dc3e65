// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mpi.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/byte_stream.hpp"
#include "host/clock.hpp"
#include "lockstep/doorbell.hpp"
#include "lockstep/host_memory.hpp"
#include "lockstep/watchdog.hpp"

namespace lockstep {

inline constexpr int kMaster = 0;

/// The job: MPI initialised for as long as this lives, and one communicator per purpose.
///
/// Only the thread that made it may call MPI (MPI_THREAD_FUNNELED). A failing MPI call ends the job: Open MPI's own
/// handler names it.
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

    /// At the master: where each rank runs and what was free there at the start, by rank. Others have none.
    [[nodiscard]] const std::vector<RankHost>& hosts() const { return hosts_; }

    [[nodiscard]] MPI_Comm frames() const { return frames_; }      // broadcasts and the barrier
    [[nodiscard]] MPI_Comm arrivals() const { return arrivals_; }  // who has come to the barrier
    [[nodiscard]] MPI_Comm pictures() const { return pictures_; }  // screenshots

    /// To be rung behind every message that a rank of this host may wait for.
    [[nodiscard]] const HostBells& bells() const { return *bells_; }

    /// Gives everyone the master's bytes; collective.
    [[nodiscard]] base::Bytes broadcast(const base::Bytes& fromMaster) const;
    /// Collects everyone's bytes at the master, by rank; others get nothing. Collective.
    [[nodiscard]] std::vector<base::Bytes> gather(const base::Bytes& mine) const;

    /// Until it is taken back, the start may take an hour: the master replays a journal, and ranks wait for it.
    void mayTakeLong(bool may) const;

    /// From the start on a watchdog limits every wait; the frame barrier brings its own and calls this.
    void startUpIsOver() const;

    /// Ends the whole job at once, for when a rank cannot be waited for.
    [[noreturn]] void abort(int status) const;

private:
    int rank_ = 0;
    int size_ = 1;
    std::unique_ptr<Watchdog> startUp_;
    std::vector<RankHost> hosts_;
    std::unique_ptr<HostBells> bells_;
    MPI_Comm frames_ = MPI_COMM_NULL;
    MPI_Comm arrivals_ = MPI_COMM_NULL;
    MPI_Comm pictures_ = MPI_COMM_NULL;
};

/// Asks the kernel to kill this process when the one that started it (mpirun, its daemon, the launcher) dies: nothing
/// may outlive the job, not even when mpirun is killed.
void dieWithParent();

[[nodiscard]] std::string hostName();
/// Resident memory of this process [byte].
[[nodiscard]] std::int64_t residentBytes();

}  // namespace lockstep
