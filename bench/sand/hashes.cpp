// SPDX-License-Identifier: Apache-2.0
// Prints the hash of the sand after many edits, by code path, number of threads and block size.
#include <random>

#include "bench/report/curves.hpp"
#include "bench/sand/relaxations.hpp"
#include "host/worker_pool.hpp"
#include "sand/grid/erosion.hpp"
#include "sand/grid/tile_hash.hpp"

namespace bench {
namespace {

constexpr int kEdits = 300;

std::uint64_t hashAfterEdits(int side, std::uint32_t seed, sand::Scheme scheme,
                             const sand::grid::Erosion::Options& options) {
    std::mt19937 random(seed);
    // The sides are odd, so that blocks and vectors are cut short at the rim.
    sand::HeightField field(side | 1, (side / 2) | 1, 1.0);
    sand::Rules rules = rulesFor(field, 0.6745, 1e-3);
    rules.scheme = scheme;
    sand::grid::Erosion erosion(field, rules, options);
    const sand::grid::Displacement tool({.radius = 5 * sand::kProbePerCell});
    const auto within = [&](int cells) {
        return static_cast<std::int32_t>(random() % static_cast<std::uint32_t>(cells * sand::kProbePerCell));
    };
    for (int i = 0; i < kEdits; ++i) {
        const sand::ProbePoint from{within(field.columns()), within(field.rows()), -within(3)};
        const sand::ProbePoint to{from.x + within(8), from.y + within(8), from.z};
        erosion.touch(tool.drag(field, rules.rim, nullptr, from, to).cells);
        erosion.sweep(field, 1 + static_cast<int>(random() % 8));
    }
    return sand::grid::TileHash(field).sum();
}

}  // namespace

void hashes(const Settings& settings, Csv& csv) {
    csv.note(
        fmt::format("{} random drags of a tool of 5 cells on a field of N x N/2 cells, both made odd, with 1 to 8 "
                    "sweeps after each",
                    kEdits));
    csv.columns("compiler,flags,scheme,code_path,threads,block,N,hash");
    for (const int side : settings.sizes) {
        for (const auto& [scheme, name] :
             {std::pair{sand::Scheme::isotropic, "G"}, {sand::Scheme::plainIsotropic, "G plain"}}) {
            for (const base::CodePath path : base::codePathsHere()) {
                for (const int threads : {1, 2, 3, 7}) {
                    host::WorkerPool pool(threads);
                    const base::Executor executor = pool.executor();
                    for (const int block : {16, 32, 64}) {
                        sand::grid::Erosion::Options options;
                        options.blockSize = block;
                        options.path = path;
                        options.executor = &executor;
                        progress("N = {}, {}, {} threads, blocks of {}", side, name, threads, block);
                        csv.row(SANDWALL_COMPILER, "\"" SANDWALL_FLAGS "\"", name, base::nameOf(path), threads, block,
                                side, fmt::format("{:016x}", hashAfterEdits(side, settings.seed, scheme, options)));
                    }
                }
            }
        }
    }
}

}  // namespace bench
