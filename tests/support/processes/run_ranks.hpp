// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tests/support/processes/mpirun.hpp"
#include "tests/support/processes/run_program.hpp"

namespace support {

/// Runs one of our programs as an MPI job on this machine. `arguments` are shell words. Ranks talk through memory, or
/// over the loopback interface if `transport` is "tcp".
inline Ran runRanks(int ranks, const std::string& program, const std::string& arguments,
                    const std::string& transport = "vader") {
    return runCommand("timeout 600 sh -c \"" + mpirunHere(transport) + " -n " + std::to_string(ranks) + " '" +
                      pathOfProgram(program) + "' " + arguments + "\"");
}

}  // namespace support
