// SPDX-License-Identifier: Apache-2.0
// Tools that arrive and are held in random scenes: on slopes, rock, walls, holes and open rims, up to extreme taluses.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <random>

#include "tests/support/borders/border_experiments.hpp"
#include "tests/support/borders/tool_kinds.hpp"
#include "tests/support/seed.hpp"

namespace {

using borders::Case;

/// Returns the number of scenes. SANDWALL_HELD_SCENES changes it (docs/testing.md).
int sceneCount() {
    const char* const given = std::getenv("SANDWALL_HELD_SCENES");
    return given == nullptr ? 60 : std::atoi(given);
}

/// A random scene, and a hand that presses a tool into it, holds it and lifts it.
class HeldScene {
public:
    explicit HeldScene(unsigned seed)
        : random_(seed), case_(chosen()), sand_(borders::sceneOf(case_)), joining_(sand_) {}

    /// Presses the tool somewhere, holds it until the sand rests, and lifts it. Returns false if a check has failed.
    bool visit() {
        const double x = between(-2, case_.columns + 2), y = between(-2, case_.rows + 2);
        const double top =
            borders::heightAt(sand_, std::clamp(x, 0.5, case_.columns - 0.5), std::clamp(y, 0.5, case_.rows - 0.5));
        if (below(3) == 0) {  // a drag on the way
            apply(true, {borders::probeAt(x - 3, y + 2, top)});
        }
        apply(true, {borders::probeAt(x, y, top + between(-0.5, 1.2) * case_.radius)});
        hold(true);
        apply(false, {});
        hold(false);
        return !testing::Test::HasFailure();
    }
    /// Holds the tool, or hovers, until the sand rests. Sweeps alone make no new extremum and move no volume away.
    void hold(bool engaged) {
        int step = 0;
        for (; step < kMostSteps && !sand_.settled() && !testing::Test::HasFailure(); ++step) {
            const auto [lowest, highest] = extremes();
            apply(engaged, {});
            const auto [lowestNow, highestNow] = extremes();
            EXPECT_LE(highestNow, highest) << text();
            EXPECT_GE(lowestNow, case_.rim == sand::Rim::open ? std::min(lowest, 0) : lowest) << text();
        }
        restedAfter_ = std::max(restedAfter_, step);
        EXPECT_TRUE(sand_.settled()) << text() << ", after " << step << " steps";
    }
    [[nodiscard]] int restedAfter() const { return restedAfter_; }
    [[nodiscard]] std::string text() const {
        return fmt::format("{} x {}, talus {}, start {}, {} of {} cells at ({}, {}, {})", case_.columns, case_.rows,
                           case_.talus, case_.start, base::nameOf(case_.tool), case_.radius, sand_.probe().x,
                           sand_.probe().y, sand_.probe().z);
    }

private:
    static constexpr int kMostSteps = 10000;  // below a tool as wide as a field of walls, sand runs for 50 s
    static constexpr double kHighest = 1.0 * sand::kMaxHeight / sand::kUnitsPerCell;  // [cell]

    int below(int end) { return static_cast<int>(random_() % static_cast<unsigned>(end)); }
    double between(double from, double to) { return from + (to - from) * static_cast<double>(below(10001)) / 10000; }

    Case chosen() {
        Case given;
        given.columns = 16 + below(24);
        given.rows = 16 + below(24);
        constexpr std::array kDegrees{34.0, 34.0, 34.0, 34.0, 20.0, 60.0, 1.0, 89.0};
        given.talus = std::tan(kDegrees.at(static_cast<std::size_t>(below(kDegrees.size()))) / 57.29578);
        constexpr std::array kBands{0.0, 0.001, 0.2, 1.0};
        given.start = given.talus * (1 + kBands.at(static_cast<std::size_t>(below(kBands.size()))));
        given.sweeps = 8 + below(25);
        given.rim = below(2) == 0 ? sand::Rim::open : sand::Rim::closed;
        const auto kinds = support::everyTool();
        given.tool = kinds.at(static_cast<std::size_t>(below(static_cast<int>(kinds.size()))));
        given.radius = below(10) == 0 ? 40 : between(1.5, 8);  // a few are wider than the field
        const double steep = between(0, 1.1) * std::min(given.talus, 2.0), way = between(0, 6.28);
        const double east = steep * std::cos(way), north = steep * std::sin(way);
        const double rough = below(3) == 0 ? between(0, 3) : 0;
        const auto seed = static_cast<unsigned>(random_());
        const auto noise = [seed](double x, double y, unsigned salt) {
            std::minstd_rand cell(seed + salt + 131 * static_cast<unsigned>(x) + 7919 * static_cast<unsigned>(y));
            cell.discard(3);
            return static_cast<double>(cell() % 1000) / 1000;
        };
        const double needles = below(12) == 0 ? 0.002 : 0;
        given.height = [=](double x, double y) {
            return noise(x, y, 5) < needles ? kHighest
                                            : 12 + east * (x - 16) + north * (y - 16) + rough * noise(x, y, 1);
        };
        if (below(3) == 0) {  // rock below the sand, with thin sand and cliffs
            constexpr double kFourUnits = 4.0 / sand::kUnitsPerCell;
            const std::array thicknesses{between(0, 0.5), 6.0, kFourUnits};
            const double thick = thicknesses.at(static_cast<std::size_t>(below(3))), cliff = below(2) == 0 ? 9 : 0;
            given.rock = [=, sand = given.height](double x, double y) {
                return sand(x, y) - thick * noise(x, y, 2) + (noise(x, y, 3) > 0.97 ? cliff : 0);
            };
        }
        if (below(3) == 0) {
            const double share = below(2) == 0 ? 0.03 : 0.2;
            given.wall = [=](int x, int y) { return noise(x, y, 4) < share; };
        }
        return given;
    }
    void apply(bool engaged, std::vector<sand::ProbePoint> path) {
        const sand::Step step{.epoch = 1, .number = ++number_, .engaged = engaged, .path = std::move(path)};
        const std::int64_t volume = sand_.volume() + sand_.outflow();
        joining_.decodeState(sand_.encodeState());
        sand_.apply(step);
        joining_.apply(step);
        EXPECT_EQ(joining_.stateHash(), sand_.stateHash()) << text() << ", step " << number_;
        EXPECT_EQ(sand_.volume() + sand_.outflow(), volume) << text() << ", step " << number_;
    }
    /// Returns the lowest and the highest sand. Walls and bare rock have none.
    [[nodiscard]] std::pair<std::int32_t, std::int32_t> extremes() const {
        const auto grid = std::get<sand::GridData>(sand_.surface().data());
        const sand::HeightField& field = grid.field;
        const sand::Ground* const ground = grid.ground;
        std::pair result{std::numeric_limits<std::int32_t>::max(), std::numeric_limits<std::int32_t>::min()};
        for (int y = 0; y < case_.rows; ++y) {
            for (int x = 0; x < case_.columns; ++x) {
                if (ground == nullptr || !ground->isWall(x, y)) {
                    result.first = std::min(result.first, field.height(x, y));
                    result.second = std::max(result.second, field.height(x, y));
                }
            }
        }
        return result;
    }

    std::mt19937 random_;
    Case case_;
    sand::Replica sand_, joining_;
    std::uint64_t number_ = 0;
    int restedAfter_ = 0;
};

// A replica that joins before a step looks at all blocks. It must find nothing that the other has missed.
TEST(HeldScenes, RestWithoutNewExtremaAndAreThoseOfAReplicaThatJoins) {
    int longest = 0;
    for (int i = 0; i < sceneCount(); ++i) {
        const unsigned seed = test::randomSeed() + static_cast<unsigned>(i);
        SCOPED_TRACE(test::again(seed));
        HeldScene scene(seed);
        scene.hold(false);
        if (!scene.visit() || !scene.visit()) {
            break;
        }
        longest = std::max(longest, scene.restedAfter());
    }
    std::printf("the longest rest came after %d steps\n", longest);
}

}  // namespace
