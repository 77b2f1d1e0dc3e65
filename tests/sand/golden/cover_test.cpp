// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <string>
#include <vector>

#include "host/worker_pool.hpp"
#include "sand/grid/dunes.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/sand/relaxing.hpp"
#include "tests/support/sand/sand_of.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

class Cover : public testing::TestWithParam<std::size_t> {};

struct Way {
    int threads, block;
    base::CodePath path;
};

// Each number of threads meets each code path of this CPU in every build. It meets each size of block in one of the
// three kinds of build: scripts/test.sh runs three builds. scripts/goldens.sh runs all optimisation levels of both
// compilers.
#ifndef __OPTIMIZE__
constexpr int kBuild = 0;
#elif defined(__clang__)
constexpr int kBuild = 1;
#else
constexpr int kBuild = 2;
#endif
constexpr std::array kThreads{1, 2, 3, 7};
constexpr std::array kBlocks{16, 32, 64};

std::size_t waysHere() { return kThreads.size() * base::codePathsHere().size(); }

Way wayOf(std::size_t i) {
    const std::size_t threads = i % kThreads.size(), path = i / kThreads.size();
    return {kThreads[threads], kBlocks[(threads + path + kBuild) % kBlocks.size()], base::codePathsHere().at(path)};
}

std::string nameOf(const Way& way) {
    std::string name = fmt::format("{}_{}ThreadsBlocksOf{}", base::nameOf(way.path), way.threads, way.block);
    std::ranges::replace(name, '-', '_');
    return name;
}

/// Dunes on a field of odd size with an open rim.
scene::Scene coveredScene() {
    scene::Scene scene = samples::flatScene(97, 61, 2.56);
    scene.rules.tuning.sweepsPerStep = 4;
    scene.rules.rim = sand::Rim::open;
    sand::grid::makeDunes({.bed = 2, .height = 6, .length = 30, .seed = 5}, scene.terrain);
    return scene;
}

// One number for ten thousand edits. It was accepted when the oracles beside this folder passed and all builds agreed.
// A change of the algorithm raises kAlgorithmVersion and replaces it.
TEST_P(Cover, TenThousandEditsHashAlike) {
    constexpr std::uint64_t kEdits = 10000;
    constexpr std::uint64_t kFew = 1000;  // for slow builds
    const scene::Scene scene = coveredScene();
    const Way way = wayOf(GetParam());
    host::WorkerPool team(way.threads);
    const base::Executor executor = team.executor();
    sand::Replica replica =
        samples::replicaSwept(scene, {.blockSize = way.block, .path = way.path, .executor = &executor});
    std::mt19937 random(47);
    std::uint64_t all = 0;  // combines every step's hash, so that each of them counts
    for (std::uint64_t edit = 1; edit <= (samples::kSlowBuild ? kFew : kEdits); ++edit) {
        replica.apply(samples::randomStep(edit, scene.rules, random));
        all = all * 31 + replica.stateHash();
        if (edit == kFew) {
            EXPECT_EQ(fmt::format("{:016x}", all), "75d765e91e1aba22");
        }
    }
    if (!samples::kSlowBuild) {
        EXPECT_EQ(fmt::format("{:016x}", all), "e6aa442bb18df3df");
    }
}

INSTANTIATE_TEST_SUITE_P(Ways, Cover, testing::Range(std::size_t{0}, waysHere()),
                         [](const auto& way) { return nameOf(wayOf(way.param)); });

}  // namespace
