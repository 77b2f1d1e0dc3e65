// SPDX-License-Identifier: Apache-2.0
// A master and three render ranks measure how far their clocks differ. The clocks and the link are simulated: each
// message carries the time at which it arrives, and takes no real time. So the results are exact. The master prints the
// result of each rank [ns].
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <mpi.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <ctime>
#include <utility>
#include <vector>

#include "lockstep/clock_sync.hpp"

namespace {

constexpr std::int64_t kMs = 1'000'000, kSecond = 1'000 * kMs;  // [ns]
// [ns] by which the clock of each rank is ahead of the master's.
constexpr std::array<std::int64_t, 4> kAhead{0, 3600 * kSecond, -5 * kSecond, 1};
constexpr int kTimeTag = 99;
// The round trip in which both ways take 20 ms. In all others one way takes longer, and the other does not.
constexpr int kBestTrip = 17;

thread_local bool simulates = false;      // in the code of lockstep/, but not inside MPI
std::int64_t trueTime = 1'000 * kSecond;  // [ns], the same time for all ranks
int myRank = 0;
std::array<int, 4> sentTo{};  // number of messages to each rank

std::int64_t wayOf(int message, bool toMaster) {
    return message == kBestTrip ? 20 * kMs : toMaster ? 20 * kMs : (25 + message) * kMs;
}

}  // namespace

// These functions take precedence over those of the C library and of Open MPI.
extern "C" {

int clock_gettime(clockid_t clock, timespec* time) noexcept {
    if (!simulates || clock != CLOCK_MONOTONIC) {
        return static_cast<int>(syscall(SYS_clock_gettime, clock, time));
    }
    const std::int64_t now = trueTime + kAhead.at(static_cast<std::size_t>(myRank));
    time->tv_sec = now / kSecond;
    time->tv_nsec = now % kSecond;
    return 0;
}

int MPI_Send(const void* data, int count, MPI_Datatype type, int to, int tag, MPI_Comm comm) {
    if (!std::exchange(simulates, false)) {
        return PMPI_Send(data, count, type, to, tag, comm);
    }
    const std::int64_t arrives = trueTime + wayOf(sentTo.at(static_cast<std::size_t>(to))++, to == 0);
    PMPI_Send(&arrives, 1, MPI_INT64_T, to, kTimeTag, comm);
    const int result = PMPI_Send(data, count, type, to, tag, comm);
    simulates = true;
    return result;
}

int MPI_Recv(void* data, int count, MPI_Datatype type, int from, int tag, MPI_Comm comm, MPI_Status* status) {
    if (!std::exchange(simulates, false)) {
        return PMPI_Recv(data, count, type, from, tag, comm, status);
    }
    std::int64_t arrives = 0;
    PMPI_Recv(&arrives, 1, MPI_INT64_T, from, kTimeTag, comm, MPI_STATUS_IGNORE);
    trueTime = std::max(trueTime, arrives);
    const int result = PMPI_Recv(data, count, type, from, tag, comm, status);
    simulates = true;
    return result;
}
}

int main(int argc, char** argv) {
    const lockstep::Cluster cluster(&argc, &argv);
    myRank = cluster.rank();
    simulates = true;
    const std::int64_t ahead = lockstep::clockAheadOfMaster(cluster);
    simulates = false;
    base::Bytes mine(sizeof ahead);
    std::memcpy(mine.data(), &ahead, sizeof ahead);
    std::vector<std::int64_t> all;
    for (const base::Bytes& one : cluster.gather(mine)) {
        std::memcpy(&all.emplace_back(), one.data(), sizeof ahead);
    }
    if (cluster.isMaster()) {
        fmt::print("{}\n", fmt::join(all, " "));
    }
    return 0;
}
