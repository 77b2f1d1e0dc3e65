// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/processes/run_program.hpp"

/// mpirun for tests that start a job themselves. scripts/launcher/job/open_mpi.py has the same knowledge for sessions.
namespace support {

/// Returns whether mpirun of this machine is of Open MPI 5.
inline bool hasOpenMpi5() {
    static const bool five = runCommand("mpirun --version").output.find("(Open MPI) 5.") != std::string::npos;
    return five;
}

/// Returns the name of mpirun's process.
inline std::string mpirunProcess() { return hasOpenMpi5() ? "prterun" : "mpirun"; }

/// Returns the beginning of a command for a job on this machine. `transport` is "vader" (shared memory) or "tcp".
inline std::string mpirunHere(const std::string& transport = "vader") {
    const std::string variables =
        "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_mpi_yield_when_idle=1 "
        "HWLOC_COMPONENTS=-gl ";
    const std::string options = " --oversubscribe --bind-to none --mca btl_tcp_if_include lo --mca btl self," +
                                (hasOpenMpi5() && transport == "vader" ? "sm" : transport);
    return variables +
           (hasOpenMpi5() ? "exec mpirun --pmixmca ptl_tcp_if_include lo"
                          : "exec mpirun -q --mca oob_tcp_if_include lo --mca odls_base_sigkill_timeout 0") +
           options;
}

/// Returns the rest of that command for several programs. `programs` has the number of ranks and the command of each,
/// in the order of ranks. The commands may hold no single quote.
inline std::string programsByRank(const std::vector<std::pair<int, std::string>>& programs) {
    std::string several;
    std::string choice;
    int ranks = 0;
    for (const auto& [count, command] : programs) {
        several += (several.empty() ? " -n " : " : -n ") + std::to_string(count) + " " + command;
        ranks += count;
        choice += "[ $PMIX_RANK -lt " + std::to_string(ranks) + " ] && exec " + command + "; ";
    }
    return hasOpenMpi5() ? " -n " + std::to_string(ranks) + " sh -c '" + choice + "'" : several;
}

/// Returns `output` without the banner of mpirun about a job that has failed, which Open MPI 5 cannot leave out.
inline std::string withoutBanner(const std::string& output) {
    std::string kept;
    bool inBanner = false;
    for (std::size_t at = 0; at < output.size();) {
        const std::size_t end = std::min(output.find('\n', at), output.size());
        const std::string line = output.substr(at, end - at);
        at = end + 1;
        if (line.starts_with("------------------------------------------------------------")) {
            inBanner = !inBanner;
        } else if (!inBanner && !(hasOpenMpi5() && line.empty())) {
            kept += line + "\n";
        }
    }
    return kept;
}

}  // namespace support
