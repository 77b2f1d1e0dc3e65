// SPDX-License-Identifier: Apache-2.0
// Each rank counts the bells that it has, sleeps until the rank before it rings, and rings the bell of the next rank.
#include <fmt/format.h>
#include <mpi.h>

#include <cstdint>

#include "lockstep/doorbell.hpp"

namespace {

constexpr std::int64_t kLong = 60'000'000'000;  // [ns]; a rank that sleeps this long has not been woken

}  // namespace

int main(int argc, char** argv) {
    MPI_Init(&argc, &argv);
    int self = 0, ranks = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &self);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    int fewest = 0, woken = 0;
    {
        const lockstep::HostBells bells;
        int known = 0;
        for (int rank = 0; rank < ranks; ++rank) {
            known += bells.of(rank) ? 1 : 0;
        }
        MPI_Allreduce(&known, &fewest, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
        if (fewest == ranks) {
            const lockstep::Doorbell mine = *bells.of(self);
            const std::uint32_t heard = mine.rings();
            MPI_Barrier(MPI_COMM_WORLD);  // no bell rings before its rank has read the number
            bells.of((self + 1) % ranks)->ring();
            const int wokenHere = mine.sleep(heard, kLong) ? 1 : 0;
            MPI_Reduce(&wokenHere, &woken, 1, MPI_INT, MPI_SUM, 0, MPI_COMM_WORLD);
        }
    }
    if (self == 0) {
        fmt::print("{} ranks, {} bells, {} woken\n", ranks, fewest, woken);
    }
    MPI_Finalize();
    return 0;
}
