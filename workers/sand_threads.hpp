// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/command_line.hpp"
#include "workers/worker_pool.hpp"

namespace workers {

/// The option by which a program that holds a replica is given threads for it.
inline void addSandThreads(host::CommandLine& line, int& threads) {
    line.option("--sand-threads", threads, "threads that sweep the sand; the sand is the same with any number")
        .range(1, kMostThreads);
}

}  // namespace workers
