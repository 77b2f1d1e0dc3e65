// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "sand/grid/erosion.hpp"
#include "sand/model/ground.hpp"
#include "tests/support/sand/laws.hpp"
#include "tests/support/sand/sand_samples.hpp"

/// Sand at the ends of its ranges, and how steep or how thick it may be at rest. Tests and the report share these
/// worlds.
namespace extremes {

/// The quantity that a world bounds.
enum class Measure : std::uint8_t {
    slope,      // slope at the steepest face, as scheme G measures it, over the talus
    face,       // largest difference of two neighbours, over that of the talus
    thickness,  // thickest layer on rock that is steeper than the talus, and beyond the sand's room at its foot
};

struct World {
    std::string name;
    sand::HeightField field;
    sand::Rules rules;
    std::optional<sand::Ground> ground = std::nullopt;
    Measure measure = Measure::slope;
    double talus = sand::kUnitsPerCell;  // difference of two neighbours at the talus [unit]
    double bound = 0;                    // of the measure [unit]
    std::string why;                     // the bound's formula, or its reason
    bool stays = false;                  // no sand may move at all
    bool slow = false;                   // takes millions of sweeps
};

struct Outcome {
    std::int64_t sweeps = 0;
    bool settled = false;
    std::int64_t lost = 0;     // volume at the start, minus volume and outflow at the end [unit · cell]
    std::int64_t outflow = 0;  // [unit · cell]
    std::int64_t moved = 0;    // sum of the differences of heights to the start [unit]
    double excess = 0;         // the measure [unit]
    samples::Extremes rest{};  // heights at rest
};

inline std::int32_t thresholdOf(double degrees) {
    return static_cast<std::int32_t>(std::tan(degrees * std::numbers::pi / 180) * sand::kUnitsPerCell);
}

/// Returns level ground at `base` with one cell at `height`.
inline sand::HeightField spike(std::int32_t base, std::int32_t height) {
    sand::HeightField field(33, 31, 1.0);
    for (int y = 0; y < 31; ++y) {
        std::fill_n(field.row(y), 33, base);
    }
    field.setHeight(16, 15, height);
    return field;
}

template <class Height>
sand::HeightField fieldOf(int columns, int rows, const Height& height) {
    sand::HeightField field(columns, rows, 1.0);
    for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < columns; ++x) {
            field.setHeight(x, y, height(x, y));
        }
    }
    return field;
}

/// Returns a world of square cells whose slopes are bounded by that of faces at rest.
inline World square(std::string name, sand::HeightField field, const samples::Law& law,
                    std::int32_t threshold = sand::kUnitsPerCell) {
    sand::Rules rules = samples::rulesFor(field, law, threshold);
    return {.name = std::move(name),
            .field = std::move(field),
            .rules = rules,
            .talus = static_cast<double>(threshold),
            .bound = samples::restingExcess(threshold, law),
            .why = "cbrt(8 t) + 4 + band"};
}

/// Returns `world` as one in which no sand may move. Its steepest slope is that of the start.
inline World still(World world) {
    world.stays = true;
    world.why = "moves nothing";
    world.bound = std::numeric_limits<double>::infinity();
    return world;
}

inline void addAngles(std::vector<World>& worlds, const samples::Law& law) {
    std::mt19937 random(19);
    World level = square("talus 0°, rough", samples::randomField(31, 33, 1 << 16, random), law, 0);
    level.measure = Measure::face;
    level.bound = 4;
    level.why = "a quarter of a face is below a unit";
    worlds.push_back(std::move(level));
    worlds.push_back(still(square("talus 0°, a spike of a unit", spike(0, 1), law, 0)));
    worlds.push_back(still(square("talus of a unit, a spike of a unit", spike(0, 1), law, 1)));
    const std::int32_t steep = thresholdOf(89.9);  // 573 cells between neighbouring cells
    const auto held = static_cast<std::int32_t>(law.band * steep);
    worlds.push_back(still(square("talus 89.9°, a spike at it", spike(0, steep + held), law, steep)));
    worlds.push_back(square("talus 89.9°, a spike beyond it", spike(0, steep + held + 1000), law, steep));
    const std::int32_t steeper = thresholdOf(89.99);  // 5730 cells, more than the range above zero
    worlds.push_back(still(square("talus 89.99°, a spike of 2^28", spike(0, sand::kMaxHeight), law, steeper)));
    worlds.push_back(square("talus 89.99°, -2^28 to 2^28", spike(-sand::kMaxHeight, sand::kMaxHeight), law, steeper));
    worlds.push_back(still(
        square("talus 89.995°, -2^28 to 2^28", spike(-sand::kMaxHeight, sand::kMaxHeight), law, thresholdOf(89.995))));
    worlds.push_back(
        still(square("talus 90°, 2^28 to -2^28", spike(sand::kMaxHeight, -sand::kMaxHeight), law, 1 << 30)));
}

inline void addHeights(std::vector<World>& worlds, const samples::Law& law) {
    constexpr std::int32_t kMost = sand::kMaxHeight;
    worlds.push_back(square("spike of 2^28 on 0", spike(0, kMost), law));
    worlds.push_back(square("pit of -2^28 in 0", spike(0, -kMost), law));
    worlds.push_back(square("spike of 2^28 on -2^28", spike(-kMost, kMost), law));
    worlds.push_back(square("pit of -2^28 in 2^28", spike(kMost, -kMost), law));
    worlds.push_back(still(square("pit of one cell", spike(0, -sand::kUnitsPerCell), law)));
    worlds.push_back(square("pit of two cells", spike(0, -2 * sand::kUnitsPerCell), law));
    worlds.push_back(square("checkerboard of ±2^28",
                            fieldOf(33, 31, [](int x, int y) { return (x + y) % 2 == 0 ? kMost : -kMost; }), law));
}

/// Across cells r = 1000 times as long as wide, a flux moves so much sand that it must be a tiny share of the
/// difference. The share is at most 0.45 / r² with inertia, and 0.4998 / (r² + 1) without. A face rests if its excess
/// over the threshold is less than a unit divided by that share: a dead band of 2.2 million units. That is 3 % of a
/// threshold of r cells. If cells are long from west to east, heights are in units of that length, and it is 34 times
/// the threshold.
inline void addCells(std::vector<World>& worlds, const samples::Law& law) {
    constexpr double kRatio = 1000;
    // Cells 1000 times as wide as long become 993 times as wide, because a rule is a whole number of 2^-16.
    constexpr std::int32_t kWide = 66;
    const double share = law.inertial() ? 0.45 / (kRatio * kRatio) : 0.4998 / (kRatio * kRatio + 1);
    // The start is near its rest, because the distance shrinks by a factor of e only in two million sweeps.
    World tall =
        square("cells 1:1000, a column of 5", fieldOf(1, 5, [](int, int y) { return y == 2 ? 72000000 : 0; }), law);
    tall.rules.aspect = 1000 * sand::kUnitsPerCell;
    tall.talus = kRatio * sand::kUnitsPerCell;
    World wide =
        square("cells 1000:1, a row of 5", fieldOf(5, 1, [](int x, int) { return x == 2 ? 5000000 : 0; }), law);
    wide.rules.aspect = kWide;
    for (World* world : {&tall, &wide}) {
        world->measure = Measure::face;
        world->bound = 1.001 / share;
        world->why = "a unit over the share of a flux";
        world->slow = true;
        worlds.push_back(std::move(*world));
    }
    World within = still(square("cells 1000:1, within the dead band",
                                fieldOf(9, 3, [](int x, int) { return x == 4 ? 2000000 : 0; }), law));
    within.rules.aspect = kWide;
    worlds.push_back(std::move(within));
}

/// Returns rock three times as steep as the talus, with sand on it whose thickness [unit] is below `most`.
inline World onRock(std::string name, std::uint32_t most, const samples::Law& law) {
    std::mt19937 random(21);
    sand::Ground ground(37, 29);
    World world = square(std::move(name),
                         fieldOf(37, 29,
                                 [&](int x, int y) {
                                     const std::int32_t rock = 3 * sand::kUnitsPerCell * x;
                                     ground.setBedrock(x, y, rock);
                                     return rock + static_cast<std::int32_t>(random() % most);
                                 }),
                         law);
    world.ground = std::move(ground);
    world.measure = Measure::thickness;
    world.bound = 3;
    world.why = "a face gives a quarter of a layer";
    return world;
}

inline void addLayersAndBorders(std::vector<World>& worlds, const samples::Law& law) {
    World thin = onRock("layers of 0 to 3 units on steep rock", 4, law);
    thin.stays = true;
    worlds.push_back(std::move(thin));
    worlds.push_back(onRock("layers of up to 20000 units on steep rock", 20000, law));
    constexpr std::int32_t kHigh = sand::kMaxHeight / 8;
    worlds.push_back(still(square("one cell", fieldOf(1, 1, [](int, int) { return kHigh; }), law)));
    worlds.push_back(square("one row of 40", fieldOf(40, 1, [](int x, int) { return x == 20 ? kHigh : 0; }), law));
    worlds.push_back(square("one column of 40", fieldOf(1, 40, [](int, int y) { return y == 20 ? kHigh : 0; }), law));
    for (const auto rim : {sand::Rim::closed, sand::Rim::open}) {
        const std::string border = rim == sand::Rim::open ? "open rim, " : "closed rim, ";
        World corner = square(border + "a spike in a corner",
                              fieldOf(33, 33, [](int x, int y) { return x + y == 0 ? kHigh : 0; }), law);
        std::mt19937 random(23);
        World rough =
            square(border + "rough heights to 2^28", samples::randomField(33, 31, sand::kMaxHeight, random), law);
        for (World* world : {&corner, &rough}) {
            world->rules.rim = rim;
            worlds.push_back(std::move(*world));
        }
    }
}

/// Returns every world, for one law.
inline std::vector<World> worlds(const samples::Law& law) {
    std::vector<World> all;
    addAngles(all, law);
    addHeights(all, law);
    addCells(all, law);
    addLayersAndBorders(all, law);
    return all;
}

inline double largestFace(const sand::HeightField& field) {
    double largest = 0;
    for (int y = 0; y < field.rows(); ++y) {
        for (int x = 0; x < field.columns(); ++x) {
            const auto to = [&](int nextX, int nextY) {
                return std::abs(static_cast<double>(field.height(nextX, nextY)) - field.height(x, y));
            };
            largest = std::max(
                {largest, x + 1 < field.columns() ? to(x + 1, y) : 0, y + 1 < field.rows() ? to(x, y + 1) : 0});
        }
    }
    return largest;
}

/// Returns the thickest layer of the world's rock east of the three western columns, which have room for all sand.
inline double thickest(const World& world, const sand::HeightField& field) {
    int thickness = 0;
    for (int y = 0; y < field.rows(); ++y) {
        for (int x = 3; x < field.columns(); ++x) {
            thickness = std::max(thickness, world.ground->sand(x, y, field.height(x, y)));
        }
    }
    return thickness;
}

inline double excessOf(const World& world, const sand::HeightField& field) {
    switch (world.measure) {
        case Measure::slope:
            return samples::steepestExcess(field, world.rules.tuning.threshold);
        case Measure::face:
            return largestFace(field) - world.talus;
        case Measure::thickness:
            return thickest(world, field);
    }
    return 0;
}

/// Sweeps the sand of a world until it rests.
inline Outcome relax(const World& world, int most = 100'000'000) {
    sand::HeightField field = world.field;
    sand::grid::Erosion erosion(field, world.rules, {.ground = world.ground ? &*world.ground : nullptr});
    Outcome outcome;
    outcome.outflow = erosion.sweep(field, most);
    outcome.sweeps = erosion.sweepsDone();
    outcome.settled = erosion.settled();
    outcome.lost = world.field.volume() - field.volume() - outcome.outflow;
    for (int y = 0; y < field.rows(); ++y) {
        for (int x = 0; x < field.columns(); ++x) {
            outcome.moved += std::abs(std::int64_t{field.height(x, y)} - world.field.height(x, y));
        }
    }
    outcome.excess = excessOf(world, field);
    outcome.rest = samples::extremesOf(field);
    return outcome;
}

}  // namespace extremes
