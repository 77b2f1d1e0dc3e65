// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include "workers/worker_pool.hpp"

namespace workers {

/// The option by which a program that holds a replica is given threads for it.
inline void addSandThreads(CLI::App& app, int& threads) {
    app.add_option("--sand-threads", threads, "threads that sweep the sand; the sand is the same with any number")
        ->check(CLI::Range(1, kMostThreads));
}

}  // namespace workers
