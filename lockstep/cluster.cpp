// SPDX-License-Identifier: Apache-2.0
#include "lockstep/cluster.hpp"

#include <fmt/format.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <numeric>

#include "host/memory.hpp"

namespace lockstep {

Cluster::Cluster(int* argc, char*** argv) {
    int provided = 0;
    MPI_Init_thread(argc, argv, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
    const auto role = isMaster()   ? Watchdog::Role::master
                      : rank_ == 1 ? Watchdog::Role::firstRank
                                   : Watchdog::Role::otherRank;
    startUp_ = std::make_unique<Watchdog>(
        [this] {
            return Wait{
                fmt::format("rank {} waits for the other ranks to start up", rank_), rank_, 0, {}, "the other ranks"};
        },
        0, role);
    startUp_->arm();
    for (MPI_Comm* communicator : {&frames_, &arrivals_, &pictures_}) {
        MPI_Comm_dup(MPI_COMM_WORLD, communicator);
    }
    bells_ = std::make_unique<HostBells>();
    base::ByteWriter here;
    here.putText(hostName());
    here.put(host::freeMemory());
    for (const base::Bytes& rank : gather(here.take())) {
        base::ByteReader reader(rank);
        RankHost& host = hosts_.emplace_back();
        host.name = reader.getText();
        host.freeBytes = reader.get<std::int64_t>();
    }
}

Cluster::~Cluster() {
    startUpIsOver();
    for (MPI_Comm* communicator : {&frames_, &arrivals_, &pictures_}) {
        MPI_Comm_free(communicator);
    }
    MPI_Finalize();
}

void Cluster::mayTakeLong(bool may) const {
    startUp_->setPatient(may);
    startUp_->arm();  // a new wait begins here
}

void Cluster::startUpIsOver() const { startUp_->disarm(); }

base::Bytes Cluster::broadcast(const base::Bytes& fromMaster) const {
    auto size = static_cast<std::uint64_t>(fromMaster.size());
    MPI_Bcast(&size, 1, MPI_UINT64_T, kMaster, frames_);
    base::Bytes bytes = fromMaster;
    bytes.resize(size);
    constexpr std::uint64_t kPiece = 1 << 30;  // [byte], because MPI counts in int
    for (std::uint64_t done = 0; done < size; done += kPiece) {
        MPI_Bcast(bytes.data() + done, static_cast<int>(std::min(kPiece, size - done)), MPI_BYTE, kMaster, frames_);
    }
    return bytes;
}

std::vector<base::Bytes> Cluster::gather(const base::Bytes& mine) const {
    const int length = static_cast<int>(mine.size());
    std::vector<int> lengths(isMaster() ? static_cast<std::size_t>(size_) : 0);
    MPI_Gather(&length, 1, MPI_INT, lengths.data(), 1, MPI_INT, kMaster, frames_);
    std::vector<int> starts(lengths.size());
    std::exclusive_scan(lengths.begin(), lengths.end(), starts.begin(), 0);
    base::Bytes all(static_cast<std::size_t>(std::accumulate(lengths.begin(), lengths.end(), 0)));
    MPI_Gatherv(mine.data(), length, MPI_BYTE, all.data(), lengths.data(), starts.data(), MPI_BYTE, kMaster, frames_);
    std::vector<base::Bytes> result;
    for (std::size_t rank = 0; rank < lengths.size(); ++rank) {
        const auto first = all.begin() + starts[rank];
        result.emplace_back(first, first + lengths[rank]);
    }
    return result;
}

void Cluster::abort(int status) const {
    MPI_Abort(MPI_COMM_WORLD, status);
    std::_Exit(status);
}

void dieWithParent() {
    const pid_t parent = getppid();
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    // If the parent ended before the call, the kernel sends no signal.
    if (getppid() != parent) {
        std::_Exit(1);
    }
}

std::string hostName() {
    std::array<char, 256> name{};
    gethostname(name.data(), name.size() - 1);
    return name.data();
}

std::int64_t residentBytes() {
    std::ifstream stream("/proc/self/statm");
    std::int64_t total = 0;
    std::int64_t resident = 0;
    stream >> total >> resident;
    return resident * sysconf(_SC_PAGESIZE);
}

}  // namespace lockstep
