// SPDX-License-Identifier: Apache-2.0
// Compares the walk over the rows with sweeps in two passes, in more sweeps than a test has time for.
// scripts/checks/walk.sh builds and runs it.
#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <optional>

#include "host/command_line.hpp"
#include "host/worker_pool.hpp"
#include "tests/sand/grid/random_worlds.hpp"
#include "tests/sand/grid/two_pass/solver.hpp"

namespace {

struct Options {
    int sweeps = 1000000;
    std::optional<base::CodePath> path;
    std::optional<int> threads;
    std::uint32_t seed = 1;
};

/// Sizes of random worlds, and the percentage of all sweeps in worlds of this size.
struct Size {
    int widest, highest;  // [cell]
    int percent;
    bool lumpy = false;
};
// Rims and blocks count most in small worlds. Rows are swept in pieces of 256 cells, and strips have 4096 cells.
constexpr std::array<Size, 4> kSizes{{{45, 45, 50}, {1000, 40, 20}, {200, 200, 15}, {150, 150, 15, true}}};

/// Returns whether both sweeps gave the same sand on one path with one number of threads, and prints it.
bool compare(const Options& options, base::CodePath path, int threads) {
    host::WorkerPool team(threads);
    const auto begin = std::chrono::steady_clock::now();
    std::string difference;
    for (const Size& size : kSizes) {
        if (difference.empty()) {
            difference = worlds::firstDifference<two_pass::Solver>(
                options.seed, static_cast<int>(std::int64_t{options.sweeps} * size.percent / 100), size.widest,
                size.highest, {.executor = team.lend(), .path = path, .lumpy = size.lumpy});
        }
    }
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    fmt::print("{}, {} threads, {} sweeps in {:.0f} s: {}\n", base::nameOf(path), threads, options.sweeps,
               seconds.count(), difference.empty() ? "equal" : difference);
    std::fflush(stdout);
    return difference.empty();
}

int run(const Options& options) {
    const std::vector<base::CodePath> paths =
        options.path ? std::vector{base::chosenCodePath(*options.path)} : base::codePathsHere();
    const std::vector<int> threads = options.threads ? std::vector{*options.threads} : std::vector{1, 2, 3, 7};
    bool equal = true;
    for (const base::CodePath path : paths) {
        for (const int count : threads) {
            equal = compare(options, path, count) && equal;
        }
    }
    return equal ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    host::CommandLine line(
        "Sweeps random worlds in one walk over their rows and in two passes, and compares the sand bit for bit.",
        "sand_walk");
    Options options;
    line.option("--sweeps", options.sweeps, "for each path and number of threads").range(1, 1000000000).showDefault();
    line.choice("--path", options.path, "only this code path (default: all that this processor has)");
    line.option("--threads", options.threads, "only this number of threads (default: 1, 2, 3 and 7)")
        .range(1, host::kMostThreads);
    line.option("--seed", options.seed, "of the first random world").showDefault();
    return host::runMain(line, argc, argv, [&] { return run(options); });
}
