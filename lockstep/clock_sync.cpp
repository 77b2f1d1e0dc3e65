// SPDX-License-Identifier: Apache-2.0
#include "lockstep/clock_sync.hpp"

#include <limits>

#include "host/clock.hpp"

namespace lockstep {
namespace {

constexpr int kRoundTrips = 32;
constexpr int kTag = 1;

}  // namespace

std::int64_t clockAheadOfMaster(const Cluster& cluster) {
    const MPI_Comm comm = cluster.arrivals();
    if (!cluster.isMaster()) {
        for (int i = 0; i < kRoundTrips; ++i) {
            MPI_Recv(nullptr, 0, MPI_BYTE, kMaster, kTag, comm, MPI_STATUS_IGNORE);
            const std::int64_t now = host::monotonicNs();
            MPI_Send(&now, 1, MPI_INT64_T, kMaster, kTag, comm);
        }
        std::int64_t ahead = 0;
        MPI_Recv(&ahead, 1, MPI_INT64_T, kMaster, kTag, comm, MPI_STATUS_IGNORE);
        return ahead;
    }
    for (int rank = 1; rank < cluster.size(); ++rank) {
        std::int64_t shortest = std::numeric_limits<std::int64_t>::max();
        std::int64_t ahead = 0;
        cluster.setMissing(rank, true);
        for (int i = 0; i < kRoundTrips; ++i) {
            std::int64_t theirs = 0;
            const std::int64_t sent = host::monotonicNs();
            MPI_Send(nullptr, 0, MPI_BYTE, rank, kTag, comm);
            MPI_Recv(&theirs, 1, MPI_INT64_T, rank, kTag, comm, MPI_STATUS_IGNORE);
            const std::int64_t roundTrip = host::monotonicNs() - sent;
            if (roundTrip < shortest) {
                shortest = roundTrip;
                ahead = theirs - (sent + roundTrip / 2);
            }
        }
        MPI_Send(&ahead, 1, MPI_INT64_T, rank, kTag, comm);
        cluster.setMissing(rank, false);
    }
    return 0;
}

}  // namespace lockstep
