// SPDX-License-Identifier: Apache-2.0
// Ten thousand edits on every rank, each sweeping in its own way; all meet after every edit and compare hashes. With
// "tools" a thousand with tools of every shape, with "tin" as many on a TIN.
#include <fmt/format.h>
#include <mpi.h>

#include <array>
#include <random>
#include <string_view>

#include "sand/dunes.hpp"
#include "sand/tin_module.hpp"
#include "tests/support/sand_samples.hpp"
#include "workers/worker_pool.hpp"

namespace {

constexpr std::uint64_t kEdits = 10000, kWildEdits = 1000;
constexpr std::array kThreads{1, 2, 3, 7};
constexpr std::array kBlocks{16, 32, 64};

sand::Scene smallScene() {
    sand::Scene scene = samples::flatScene(41, 29, 2.56);
    scene.rules.sweepsPerStep = 4;
    scene.rules.rim = sand::Rim::open;
    sand::makeDunes({.bed = 2, .height = 5, .length = 20, .seed = 7}, scene.terrain);
    return scene;
}

sand::Scene smallTin() {
    sand::Scene scene = smallScene();
    auto start = sand::tinModule().follow(scene.terrain, {.spacing = 300, .maxError = 8000, .mostVertices = 2000});
    scene.rules.tin = start.digest();
    scene.tin = std::make_shared<const sand::tin::Start>(std::move(start));
    scene.terrain = sand::HeightField(1, 1, scene.terrain.cellSize());
    return scene;
}

/// The first edit after which ranks differ, or 0; `all` takes in every hash.
std::uint64_t editAll(int rank, std::string_view kind, std::uint64_t& all) {
    const auto way = static_cast<std::size_t>(rank);
    workers::WorkerPool team(kThreads.at(way % kThreads.size()));
    const sand::Scene scene = kind == "tin" ? smallTin() : smallScene();
    const bool wild = !kind.empty();
    sand::Terrain terrain(scene, {.blockSize = kBlocks.at(way % kBlocks.size()),
                                  .path = way % 2 == 0 ? sand::CodePath::automatic : sand::CodePath::baseline,
                                  .executor = team.lend()});
    std::mt19937 random(53);
    for (std::uint64_t edit = 1; edit <= (wild ? kWildEdits : kEdits); ++edit) {
        terrain.apply(wild ? samples::wildStep(edit, scene.rules, random)
                           : samples::randomStep(edit, scene.rules, random));
        const std::uint64_t hash = terrain.stateHash();
        // Equal where the largest hash and the largest complement belong to one.
        const std::array<std::uint64_t, 2> mine{hash, ~hash};
        std::array<std::uint64_t, 2> largest{};
        MPI_Allreduce(mine.data(), largest.data(), 2, MPI_UINT64_T, MPI_MAX, MPI_COMM_WORLD);
        if (largest[0] != ~largest[1]) {
            return edit;
        }
        all = all * 31 + hash;
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
