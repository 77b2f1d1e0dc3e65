// SPDX-License-Identifier: Apache-2.0
// Sand of a height field that no session has made. tests/sand/tin/hostile_sand_test.cpp does the same with a TIN.
#include "tests/support/sand/hostile_sand.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <limits>
#include <memory>

#include "sand/model/ground.hpp"
#include "sand/replica.hpp"
#include "tests/support/machine/memory_limit.hpp"
#include "tests/support/sand/sand_of.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

using sand::Replica;

constexpr std::int64_t kCells = 24 * 16;

TEST(HostileGrid, WithMoreOutflowThanSandIsRefused) {
    const scene::Scene scene = samples::flatScene(24, 16);
    Replica replica(scene);
    const base::Bytes sand = replica.copySand()->encode();
    const auto stateOf = [&](std::int64_t outflow) {
        return hostile_sand::stateWith(replica, hostile_sand::withOutflow(sand, outflow));
    };
    // The field is level at height 0. All the sand that it could have lost is kMaxHeight in every cell.
    constexpr std::int64_t kMost = kCells * sand::kMaxHeight;
    for (const std::int64_t outflow :
         {std::numeric_limits<std::int64_t>::max(), std::numeric_limits<std::int64_t>::min(), kMost + 1, -kMost - 1}) {
        EXPECT_THROW(replica.decodeState(stateOf(outflow)), base::FormatError) << outflow;
    }
    for (const std::int64_t outflow : {kMost, -kMost, std::int64_t{0}}) {
        EXPECT_NO_THROW(replica.decodeState(stateOf(outflow))) << outflow;
        EXPECT_EQ(replica.outflow(), outflow);
    }
}

TEST(HostileGrid, AfterMoreStepsThanCanBeCountedIsRefused) {
    const scene::Scene scene = samples::flatScene(24, 16);
    Replica replica(scene);
    base::Bytes state = replica.encodeState();
    const auto numbered = [&](std::uint64_t number) {
        std::memcpy(state.data() + sizeof sand::kStateVersion, &number, sizeof number);
        return state;
    };
    EXPECT_THROW(replica.decodeState(numbered(std::numeric_limits<std::uint64_t>::max())), base::FormatError);
    replica.decodeState(numbered(std::uint64_t{1} << 62));
    replica.apply({.epoch = 1, .number = (std::uint64_t{1} << 62) + 1, .engaged = false, .path = {}});
    EXPECT_EQ(replica.stepNumber(), (std::uint64_t{1} << 62) + 1);
}

// Steps of a hand take milliseconds. This one would take hours, in every rank and in every replay.
TEST(HostileGrid, IsNotDraggedAlongAPathThatTakesHours) {
    const auto pathOver = [](int cells, std::size_t points) {
        std::vector<sand::ProbePoint> path;
        for (std::size_t i = 0; i < points; ++i) {
            path.push_back(
                {static_cast<std::int32_t>(i % 2) * cells * sand::kProbePerCell, 8 * sand::kProbePerCell, 0});
        }
        return path;
    };
    // 64 points are 63 ways of 1023 sub-steps and more. A tool of 400 cells covers 802 x 802 cells. Together that is
    // 4.1e10, and the limit is 2^27 = 1.3e8. Three points with 202 x 202 cells are 8.3e7.
    const auto apply = [&](double toolCells, const std::vector<sand::ProbePoint>& path) {
        Replica replica(samples::flatScene(1024, 1024, toolCells));
        replica.apply({.epoch = 1, .number = 1, .engaged = true, .path = path});
        EXPECT_EQ(replica.probe(), path.back()) << "the tool is there, whether it moved the sand or not";
        return replica.leftOut();
    };
    EXPECT_NE(apply(400, pathOver(1023, 64)), "");
    EXPECT_EQ(apply(100, pathOver(1023, 3)), "") << "a fast hand";
    EXPECT_EQ(apply(4, pathOver(1023, 64)), "") << "a small tool";
}

// A small tool costs little in each sub-step, and a frame cannot divide the step.
TEST(HostileGrid, IsNotDraggedToAndFroOverTheLongestWay) {
    Replica replica(samples::flatScene(24, 16, 1));
    std::vector<sand::ProbePoint> path{{8 * sand::kProbePerCell, 8 * sand::kProbePerCell, 0}};
    replica.apply({.number = 1, .engaged = true, .path = path});
    for (std::size_t i = 0; i < sand::kMaxPathPoints; ++i) {
        path.push_back({i % 2 == 0 ? -sand::kMaxProbe : sand::kMaxProbe, 8 * sand::kProbePerCell, 0});
    }
    path.erase(path.begin());
    const std::int64_t volume = samples::fieldOf(replica).volume();
    replica.apply({.number = 2, .engaged = true, .path = path});
    // From column 8 to the west, and 63 ways of 131,072 cells each.
    EXPECT_EQ(replica.leftOut(), "its path was left out: it has 8323080 sub-steps, and with this tool at most 2097152");
    EXPECT_EQ(replica.lastWork().substeps, 0);
    EXPECT_EQ(replica.probe(), path.back());
    EXPECT_EQ(samples::fieldOf(replica).volume(), volume);
    path.resize(16);
    replica.apply({.number = 3, .engaged = true, .path = path});
    EXPECT_EQ(replica.leftOut(), "") << "16 of these ways are within the limit";
    EXPECT_EQ(replica.lastWork().substeps, 16 * 131'072);
    EXPECT_EQ(samples::fieldOf(replica).volume(), volume);
}

// Whether there is memory depends on the host. A replica without memory must not leave out a step that the others
// apply. Sanitizers need more memory than any limit, so that their builds do not have this test.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST(HostileGrid, WithoutMemoryEndsTheProcessThatAppliesTheStep) {
    const std::string said = test::inTwoGiB([] {
        Replica replica(samples::flatScene(4096, 4096));  // 64 MiB of heights
        // Room for a copy of the heights and for putting it back, which a replica needs that leaves out the step.
        // Settling needs more.
        rlim_t pages = 0;
        std::ifstream("/proc/self/statm") >> pages;
        const rlim_t most = pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + (rlim_t{160} << 20);
        const rlimit limit{most, most};
        setrlimit(RLIMIT_AS, &limit);
        replica.apply({.epoch = 1, .number = 1, .engaged = false, .path = {}, .edit = {sand::Edit::settle}});
    });
    EXPECT_EQ(said, std::bad_alloc().what());
}
#endif

/// Returns a scene with rock one cell below level sand.
scene::Scene sceneWithRock() {
    scene::Scene scene = samples::flatScene(24, 16);
    auto ground = std::make_shared<sand::Ground>(24, 16);
    for (int y = 0; y < 16; ++y) {
        for (int x = 0; x < 24; ++x) {
            ground->setBedrock(x, y, -sand::kUnitsPerCell);
        }
    }
    ground->setWall(5, 5);
    scene.rules.ground = ground->digest();
    scene.ground = std::move(ground);
    return scene;
}

// A layer of negative thickness would pull sand out of its neighbours. The deficit of all cells would meet in one cell,
// whose height would overflow.
TEST(HostileGrid, BelowRockIsRefusedAndItsLoadIgnored) {
    const scene::Scene scene = sceneWithRock();
    const auto sandAt = [&scene](int column, std::int32_t height) {
        scene::Scene deep = scene;
        deep.terrain.setHeight(column, 5, height);
        deep.ground = nullptr;
        return Replica(deep).copySand()->encode();
    };
    Replica replica(scene);
    const base::Bytes below = sandAt(6, -sand::kUnitsPerCell - 1);
    EXPECT_THROW(replica.decodeState(hostile_sand::stateWith(replica, below)), base::FormatError);
    replica.apply({.epoch = 1, .number = 1, .engaged = false, .path = {}, .edit = sand::Edit::loaded(below)});
    EXPECT_EQ(samples::fieldOf(replica).volume(), 0) << "the load was ignored";
    EXPECT_NE(replica.leftOut(), "");
    for (const auto& [column, height] : {std::pair{6, -sand::kUnitsPerCell}, {5, -9 * sand::kUnitsPerCell}}) {
        EXPECT_NO_THROW(replica.decodeState(hostile_sand::stateWith(replica, sandAt(column, height))))
            << "bare rock, and a wall cell, whose height has no meaning";
    }
}

}  // namespace
