// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tests/support/run_program.hpp"

namespace support {

/// Runs one of our programs as an MPI job on this machine. `arguments` are shell words. Ranks talk through memory, or
/// over the loopback interface if `transport` is "tcp".
inline Ran runRanks(int ranks, const std::string& program, const std::string& arguments,
                    const std::string& transport = "vader") {
    return runCommand(
        "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_mpi_yield_when_idle=1 "
        "HWLOC_COMPONENTS=-gl timeout 600 mpirun -q --oversubscribe --bind-to none --mca oob_tcp_if_include lo "
        "--mca btl_tcp_if_include lo --mca btl self," +
        transport + " -n " + std::to_string(ranks) + " " SANDWALL_BIN_DIR "/" + program + " " + arguments);
}

}  // namespace support
