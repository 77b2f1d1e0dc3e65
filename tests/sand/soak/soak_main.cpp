// SPDX-License-Identifier: Apache-2.0
// Session that takes too long or too much memory for a test. scripts/checks/soak.sh runs it and compares the results.
#include <fmt/format.h>
#include <sys/resource.h>

#include <chrono>
#include <cstdio>
#include <random>

#include "host/command_line.hpp"
#include "host/worker_pool.hpp"
#include "sand/grid/dunes.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/sand/sand_of.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

struct Options {
    std::uint64_t edits = 1000000;
    int columns = 61, rows = 43;  // [cell]
    int threads = 1;
    int block = sand::grid::Erosion::kDefaultBlock;  // [cell]
    base::CodePath path = base::fastestCodePath();
    std::uint32_t seed = 53;
};

double peakGibibytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / (1 << 20);  // Linux counts in KiB
}

scene::Scene dunes(const Options& options) {
    scene::Scene scene = samples::flatScene(options.columns, options.rows, 2.56);
    sand::grid::makeDunes({.bed = 2, .height = 6, .length = 30, .seed = 5}, scene.terrain);
    scene.rules.tuning.sweepsPerStep = 4;
    return scene;
}

int run(const Options& options) {
    host::WorkerPool team(options.threads);
    const base::Executor executor = team.executor();
    const sand::Rules rules = dunes(options).rules;
    sand::Replica replica =
        samples::replicaSwept(dunes(options), {.blockSize = options.block,
                                               .path = base::chosenCodePath(options.path),
                                               .executor = options.threads > 1 ? &executor : nullptr});
    const std::int64_t volume = samples::fieldOf(replica).volume();
    std::mt19937 random(options.seed);
    std::uint64_t all = 0;
    const auto begin = std::chrono::steady_clock::now();
    for (std::uint64_t edit = 1; edit <= options.edits; ++edit) {
        replica.apply(samples::randomStep(edit, rules, random));
        all = all * 31 + replica.stateHash();
        if (edit % std::max<std::uint64_t>(options.edits / 10, 1) == 0) {
            const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
            fmt::print(stderr, "soak: {} edits in {:.0f} s, hash of all steps {:016x}\n", edit, seconds.count(), all);
        }
    }
    if (samples::fieldOf(replica).volume() + replica.outflow() != volume) {
        fmt::print(stderr, "soak: the volume was {} and is {}\n", volume,
                   samples::fieldOf(replica).volume() + replica.outflow());
        return 1;
    }
    fmt::print("{:016x}\n", all);
    fmt::print(stderr, "soak: {} x {} cells, {} threads, blocks of {}, {} sweeps: peak of {:.3g} GiB\n",
               options.columns, options.rows, options.threads, options.block, samples::erosionOf(replica).sweepsDone(),
               peakGibibytes());
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    host::CommandLine line(
        "Applies random edits, hashes the sand after every step, and prints one hash over all steps.", "sand_soak");
    Options options;
    line.option("--edits", options.edits, "how many").showDefault();
    line.option("--columns", options.columns).range(1, sand::kMaxSide).showDefault();
    line.option("--rows", options.rows).range(1, sand::kMaxSide).showDefault();
    line.option("--threads", options.threads).range(1, 256).showDefault();
    line.option("--block", options.block, "side of a block [cell]").range(2, 128).showDefault();
    line.choice("--path", options.path, "code path of the sweeps");
    line.option("--seed", options.seed).showDefault();
    return host::runMain(line, argc, argv, [&] { return run(options); });
}
