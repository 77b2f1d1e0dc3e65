// SPDX-License-Identifier: Apache-2.0
// Ten thousand edits on every rank. Each rank sweeps in another way, and all compare the hashes after every edit. They
// compare a hundred hashes at a time, because on few cores a meeting of twelve ranks after each edit takes longer than
// the sand. With "tools", a thousand edits with tools of every shape. With "tin", a thousand edits on a TIN.
#include <fmt/format.h>
#include <mpi.h>

#include <array>
#include <random>
#include <string_view>
#include <vector>

#include "host/worker_pool.hpp"
#include "sand/grid/dunes.hpp"
#include "sand/tin/refine/start_maker.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/sand/sand_of.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

constexpr std::uint64_t kEdits = 10000, kWildEdits = 1000, kTogether = 100;
constexpr std::array kThreads{1, 2, 3, 7};
constexpr std::array kBlocks{16, 32, 64};

scene::Scene smallScene() {
    scene::Scene scene = samples::flatScene(41, 29, 2.56);
    scene.rules.tuning.sweepsPerStep = 4;
    scene.rules.rim = sand::Rim::open;
    sand::grid::makeDunes({.bed = 2, .height = 5, .length = 20, .seed = 7}, scene.terrain);
    return scene;
}

scene::Scene smallTin() {
    scene::Scene scene = smallScene();
    const sand::tin::Settings settings{.spacing = 300, .maxError = 8000, .mostVertices = 2000};
    auto start = sand::tin::follow(scene.terrain, nullptr, settings, scene.rules.rim).start;
    scene.rules.tin = start.digest();
    scene.tin = std::make_shared<const sand::tin::TinStart>(std::move(start));
    scene.terrain = sand::HeightField(1, 1, scene.terrain.cellSize());
    return scene;
}

/// Returns the index of the first of `hashes` that differs between ranks; the number of hashes if all are equal.
/// Collective.
std::size_t firstDifference(const std::vector<std::uint64_t>& hashes) {
    // Hashes are equal if the largest hash and the largest complement belong to the same hash.
    std::vector<std::uint64_t> largest = hashes;
    for (const std::uint64_t hash : hashes) {
        largest.push_back(~hash);
    }
    MPI_Allreduce(MPI_IN_PLACE, largest.data(), static_cast<int>(largest.size()), MPI_UINT64_T, MPI_MAX,
                  MPI_COMM_WORLD);
    std::size_t place = 0;
    while (place < hashes.size() && largest[place] == ~largest[hashes.size() + place]) {
        ++place;
    }
    return place;
}

/// Returns the first edit after which ranks differ, or 0. `all` becomes a hash over all hashes.
std::uint64_t editAll(int rank, std::string_view kind, std::uint64_t& all) {
    const auto way = static_cast<std::size_t>(rank);
    const std::vector<base::CodePath> paths = base::codePathsHere();
    host::WorkerPool team(kThreads.at(way % kThreads.size()));
    const scene::Scene scene = kind == "tin" ? smallTin() : smallScene();
    const bool wild = !kind.empty();
    sand::Replica replica = kind == "tin"
                                ? sand::Replica(scene, team.lend())
                                : samples::replicaSwept(scene, {.blockSize = kBlocks.at(way % kBlocks.size()),
                                                                .path = paths.at(way / kThreads.size() % paths.size()),
                                                                .executor = team.lend()});
    std::mt19937 random(53);
    for (std::uint64_t before = 0; before < (wild ? kWildEdits : kEdits); before += kTogether) {
        std::vector<std::uint64_t> hashes;
        for (std::uint64_t edit = before + 1; edit <= before + kTogether; ++edit) {
            replica.apply(wild ? samples::wildStep(edit, scene.rules, random)
                               : samples::randomStep(edit, scene.rules, random));
            hashes.push_back(replica.stateHash());
            all = all * 31 + hashes.back();
        }
        const std::size_t differs = firstDifference(hashes);
        if (differs < hashes.size()) {
            return before + differs + 1;
        }
    }
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    MPI_Init(&argc, &argv);
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    std::uint64_t all = 0;
    const std::uint64_t differing = editAll(rank, argc > 1 ? argv[1] : "", all);
    if (rank == 0) {
        fmt::print("{}\n",
                   differing == 0 ? fmt::format("{:016x}", all) : fmt::format("ranks differ after {}", differing));
    }
    MPI_Finalize();
    return differing == 0 ? 0 : 1;
}
