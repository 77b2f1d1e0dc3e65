// SPDX-License-Identifier: Apache-2.0
#include "host/worker_pool.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <latch>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/float_environment.hpp"
#include "sand/grid/erosion.hpp"
#include "tests/support/machine/other_floats.hpp"
#include "tests/support/sand/relaxing.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

using host::WorkerPool;

TEST(WorkerPool, RunsEveryTaskOnce) {
    for (const int threads : {1, 2, 3, 7}) {
        WorkerPool pool(threads);
        for (const int count : {0, 1, 2, 6, 1000}) {
            std::vector<std::atomic<int>> runs(static_cast<std::size_t>(count));
            pool.run(count, [&](int i) { ++runs[static_cast<std::size_t>(i)]; });
            EXPECT_TRUE(std::all_of(runs.begin(), runs.end(), [](const auto& n) { return n == 1; }))
                << count << " tasks on " << threads << " threads";
        }
    }
}

// Each task waits until the others have begun. With fewer than three threads this test would hang.
TEST(WorkerPool, WorksOnAllThreadsAtOnce) {
    WorkerPool pool(3);
    std::latch begun(3);
    pool.run(3, [&](int) { begun.arrive_and_wait(); });
    EXPECT_TRUE(begun.try_wait());
}

TEST(WorkerPool, ItsThreadsComputeAsTheSandNeedsAlthoughTheirCreatorDoesNot) {
    std::unique_ptr<WorkerPool> pool;
    {
        const test::OtherFloats other;
        pool = std::make_unique<WorkerPool>(3);
        pool->run(3, [](int) {});
    }
    std::latch begun(3);
    std::array<std::string, 3> unusual;
    pool->run(3, [&](int i) {
        unusual[static_cast<std::size_t>(i)] = base::unusualFloats();
        begun.arrive_and_wait();
    });
    for (const std::string& words : unusual) {
        EXPECT_EQ(words, "");
    }
}

TEST(WorkerPool, RefusesToBeNobodyOrAMob) {
    EXPECT_THROW(WorkerPool(0), std::invalid_argument);
    EXPECT_THROW(WorkerPool(host::kMostThreads + 1), std::invalid_argument);
}

TEST(WorkerPool, TheSandIsTheSameOnAnyNumberOfThreads) {
    constexpr unsigned kSeed = 41;
    std::mt19937 random(kSeed);
    const sand::HeightField start = samples::randomField(203, 151, 1 << 22, random);
    sand::Ground ground(203, 151);
    for (int y = 40; y < 110; ++y) {
        ground.setWall(97, y);
        ground.setBedrock(60, y, start.height(60, y) / 2);
    }
    for (const auto scheme : samples::kSchemes) {
        sand::Rules rules = samples::flatScene(203, 151).rules;
        rules.scheme = scheme;
        rules.rim = sand::Rim::open;
        sand::HeightField expected = start;
        const std::int64_t outflow = sand::grid::Erosion(expected, rules, {.ground = &ground}).sweep(expected, 40);
        for (const int threads : {1, 2, 3, 7}) {
            WorkerPool pool(threads);
            const base::Executor executor = pool.executor();
            sand::HeightField field = start;
            sand::grid::Erosion erosion(field, rules, {.ground = &ground, .executor = &executor});
            EXPECT_EQ(erosion.sweep(field, 40), outflow);
            EXPECT_TRUE(sameHeights(field, expected)) << threads << " threads, seed " << kSeed;
        }
    }
}

}  // namespace
