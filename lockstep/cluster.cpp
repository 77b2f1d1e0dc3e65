// SPDX-License-Identifier: Apache-2.0
#include "lockstep/cluster.hpp"

#include <fmt/format.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <numeric>

#include "host/memory.hpp"
#include "host/print_line.hpp"
#include "lockstep/backoff.hpp"
#include "lockstep/sibling_watch.hpp"

namespace lockstep {
namespace {

enum ClusterTag : int { kGatherLengthTag = 30, kGatherTag, kFarewellTag };  // cluster_start.cpp has more

constexpr const char* kInit = "the start of MPI";
constexpr const char* kStart = "the start";
constexpr const char* kEnd = "the end of the session";

/// Returns the rank of this process in its job, as mpirun tells it before MPI_Init; 0 without mpirun.
int rankOfJob() {
    const char* const rank = std::getenv("OMPI_COMM_WORLD_RANK");
    return rank == nullptr ? 0 : std::atoi(rank);
}

}  // namespace

Cluster::Cluster(int* argc, char*** argv) : rank_(rankOfJob()), phase_(kInit) {
    watchdog_ = std::make_unique<Watchdog>([this] { return describeWait(); }, 0, Watchdog::roleOf(rank_),
                                           [this](const std::string& line) {
                                               const std::lock_guard lock(mutex_);
                                               if (lastWords_) {
                                                   const std::vector<int> late = missing();
                                                   lastWords_(late.empty() ? -1 : late.front(), line);
                                               }
                                           });
    watchdog_->arm();
    int provided = 0;
    const SiblingWatch siblings([] {  // until gather() has heard of all ranks
        host::printLine("a process of this job on {} has ended, and mpirun waits for it; ending the job", hostName());
        std::fflush(nullptr);
        std::_Exit(1);
    });
    MPI_Init_thread(argc, argv, MPI_THREAD_FUNNELED, &provided);
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    rank_ = rank;
    watchdog_->setRole(Watchdog::roleOf(rank));
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
    missing_ = std::make_unique<std::atomic<bool>[]>(static_cast<std::size_t>(size_));
    missingSize_ = size_;
    phase_ = kStart;
    for (MPI_Comm* communicator : {&frames_, &arrivals_, &pictures_}) {
        MPI_Comm_dup(MPI_COMM_WORLD, communicator);
    }
    // MPI_Finalize first deletes the attributes of MPI_COMM_SELF. Messages are still allowed then.
    int key = MPI_KEYVAL_INVALID;
    const auto farewell = [](MPI_Comm, int, void* self, void*) {
        static_cast<const Cluster*>(self)->farewell();
        return MPI_SUCCESS;
    };
    MPI_Comm_create_keyval(MPI_COMM_NULL_COPY_FN, farewell, &key, nullptr);
    MPI_Comm_set_attr(MPI_COMM_SELF, key, this);
    bells_ = std::make_unique<HostBells>();
    for (const base::Bytes& one : gather(base::encoded(RankHost{hostName(), host::freeMemory(), machineId()}))) {
        hosts_.push_back(base::decoded<RankHost>(one));
    }
}

Cluster::~Cluster() {
    phase_ = kEnd;
    watchdog_->arm();
    MPI_Finalize();
    watchdog_->disarm();
}

/// Called by MPI_Finalize, before it ends anything.
void Cluster::farewell() const {
    if (isMaster()) {
        std::vector<int> ranks(static_cast<std::size_t>(renderRanks()));
        std::iota(ranks.begin(), ranks.end(), 1);
        std::vector<MPI_Request> requests(ranks.size(), MPI_REQUEST_NULL);
        for (std::size_t i = 0; i < ranks.size(); ++i) {
            MPI_Irecv(nullptr, 0, MPI_BYTE, ranks[i], kFarewellTag, arrivals_, &requests[i]);
        }
        await(requests, ranks);
    } else {
        MPI_Send(nullptr, 0, MPI_BYTE, kMaster, kFarewellTag, arrivals_);
    }
    for (MPI_Comm communicator : {frames_, arrivals_, pictures_}) {
        MPI_Comm_free(&communicator);
    }
}

void Cluster::setLastWords(std::vector<std::string> names, LastWords lastWords) const {
    const std::lock_guard lock(mutex_);
    if (!names.empty()) {
        names_ = std::move(names);
    }
    lastWords_ = std::move(lastWords);
}

void Cluster::mayTakeLong(bool may) const {
    watchdog_->setPatient(may);
    watchdog_->arm();  // a new wait begins here
}

void Cluster::startUpIsOver() const { watchdog_->disarm(); }

void Cluster::endBegins(double limitSeconds) const {
    phase_ = kEnd;
    watchdog_->setLimit(limitSeconds);
    watchdog_->startUpIsOver();
    watchdog_->arm();
}

void Cluster::setMissing(int rank, bool missing) const { missing_[static_cast<std::size_t>(rank)] = missing; }

std::vector<int> Cluster::missing() const {
    std::vector<int> ranks;
    for (int rank = 0; rank < missingSize_; ++rank) {
        if (missing_[static_cast<std::size_t>(rank)]) {
            ranks.push_back(rank);
        }
    }
    return ranks;
}

Wait Cluster::describeWait() const {
    Wait wait;
    wait.by = rank_;
    const bool ofInit = phase_ == kInit;
    if (rank_ != kMaster && !ofInit) {
        wait.ranks = {kMaster};
        wait.names = "the master";
    } else {
        wait.ranks = missing();
        const std::lock_guard lock(mutex_);
        for (const int rank : wait.ranks) {
            const auto index = static_cast<std::size_t>(rank);
            wait.names += wait.names.empty() ? "" : ", ";
            wait.names += index < names_.size() ? names_[index] : fmt::format("rank {}", rank);
        }
    }
    const char* const own = ownWork_;
    wait.names = !wait.names.empty() ? wait.names : own != nullptr ? own : "the other ranks";
    wait.text = fmt::format("{} of rank {} waits for {}", phase_.load(), wait.by, wait.names);
    if (rank_ == kMaster) {
        wait.text = fmt::format("{} waits for {}", phase_.load(), wait.names);
    }
    return wait;
}

void Cluster::await(std::span<MPI_Request> requests, std::span<const int> ranks,
                    const std::function<void()>& between) const {
    for (const int rank : ranks) {
        setMissing(rank, true);
    }
    Backoff backoff;
    for (std::size_t done = 0; done < requests.size();) {
        int which = MPI_UNDEFINED;
        int found = 0;
        MPI_Testany(static_cast<int>(requests.size()), requests.data(), &which, &found, MPI_STATUS_IGNORE);
        if (between) {
            between();
        }
        if (found == 0 || which == MPI_UNDEFINED) {
            backoff.rest();
            continue;
        }
        setMissing(ranks[static_cast<std::size_t>(which)], false);
        ++done;
    }
}

base::Bytes Cluster::broadcast(const base::Bytes& fromMaster, const std::function<void(double)>& sent) const {
    auto size = static_cast<std::uint64_t>(fromMaster.size());
    MPI_Bcast(&size, 1, MPI_UINT64_T, kMaster, frames_);
    base::Bytes got(isMaster() ? 0 : size);
    // One pointer serves both directions; the master only reads from it.
    std::uint8_t* const data = isMaster() ? const_cast<std::uint8_t*>(fromMaster.data()) : got.data();
    constexpr std::uint64_t kLeastPiece = 1 << 20;  // [byte]; smaller pieces would take longer
    const std::uint64_t piece = std::clamp(size / 100, kLeastPiece, kMpiPiece);
    mayTakeLong(false);
    for (std::uint64_t done = 0; done < size; done += piece) {
        MPI_Bcast(data + done, static_cast<int>(std::min(piece, size - done)), MPI_BYTE, kMaster, frames_);
        watchdog_->arm();
        if (sent) {
            sent(static_cast<double>(std::min(done + piece, size)) / static_cast<double>(size));
        }
    }
    return got;
}

/// The master receives from each rank by itself. Inside MPI_Gather it could not know which rank is missing.
std::vector<base::Bytes> Cluster::gather(const base::Bytes& mine, const std::function<void()>& between) const {
    auto length = static_cast<std::uint64_t>(mine.size());
    if (!isMaster()) {
        MPI_Send(&length, 1, MPI_UINT64_T, kMaster, kGatherLengthTag, frames_);
        MPI_Send(mine.data(), static_cast<int>(length), MPI_BYTE, kMaster, kGatherTag, frames_);
        return {};
    }
    std::vector<int> ranks(static_cast<std::size_t>(renderRanks()));
    std::iota(ranks.begin(), ranks.end(), 1);
    std::vector<std::uint64_t> lengths(ranks.size());
    std::vector<base::Bytes> all(ranks.size() + 1);
    std::vector<MPI_Request> requests(ranks.size(), MPI_REQUEST_NULL);
    for (std::size_t i = 0; i < ranks.size(); ++i) {
        MPI_Irecv(&lengths[i], 1, MPI_UINT64_T, ranks[i], kGatherLengthTag, frames_, &requests[i]);
    }
    await(requests, ranks, between);
    all.front() = mine;
    for (std::size_t i = 0; i < ranks.size(); ++i) {
        all[i + 1].resize(lengths[i]);
        MPI_Irecv(all[i + 1].data(), static_cast<int>(lengths[i]), MPI_BYTE, ranks[i], kGatherTag, frames_,
                  &requests[i]);
    }
    await(requests, ranks, between);
    return all;
}

void Cluster::abort(int status) const {
    watchdog_->arm();
    reserve_.reset();
    MPI_Abort(MPI_COMM_WORLD, status);
    std::_Exit(status);
}

void endWithParent() {
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

std::string machineId() {
    std::ifstream stream("/proc/sys/kernel/random/boot_id");
    std::string boot;
    stream >> boot;
    return hostName() + "/" + boot;
}

std::int64_t residentBytes() {
    std::ifstream stream("/proc/self/statm");
    std::int64_t total = 0;
    std::int64_t resident = 0;
    stream >> total >> resident;
    return resident * sysconf(_SC_PAGESIZE);
}

}  // namespace lockstep
