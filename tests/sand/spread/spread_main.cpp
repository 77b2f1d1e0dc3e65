// SPDX-License-Identifier: Apache-2.0
// Compares whole steps with steps in parts, in more random sessions than a test has time for. scripts/checks/spread.sh
// builds and runs it.
#include <fmt/format.h>

#include <cstdio>

#include "host/command_line.hpp"
#include "host/worker_pool.hpp"
#include "tests/sand/spread/sessions.hpp"

namespace {

struct Options {
    int sessions = 1000;
    int steps = 40;
    unsigned seed = 1;
};

int run(const Options& options) {
    host::WorkerPool team(3);
    int wrong = 0;
    for (int i = 0; i < options.sessions; ++i) {
        const std::string difference =
            spread::firstDifference(options.seed + static_cast<unsigned>(i), options.steps, team.lend());
        if (!difference.empty()) {
            fmt::print("{}\n", difference);
            std::fflush(stdout);
            ++wrong;
        }
    }
    fmt::print("{} sessions of {} steps: {} differ\n", options.sessions, options.steps, wrong);
    return wrong == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    host::CommandLine line(
        "Plays random sessions with whole steps and with steps in parts, and compares the sand bit for bit.",
        "sand_spread");
    Options options;
    line.option("--sessions", options.sessions, "number of sessions").range(1, 1000000).showDefault();
    line.option("--steps", options.steps, "steps of the hand in each session").range(1, 100000).showDefault();
    line.option("--seed", options.seed, "of the first session").showDefault();
    return host::runMain(line, argc, argv, [&] { return run(options); });
}
