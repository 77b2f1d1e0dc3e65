// SPDX-License-Identifier: Apache-2.0
// Tools with a coarse phase, beside the path of all sweeps, and as state of a replica.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/worker_pool.hpp"
#include "sand/replica.hpp"
#include "tests/support/sand/relaxing.hpp"
#include "tests/support/sand/sand_of.hpp"
#include "tests/support/sand/sand_samples.hpp"
#include "tests/support/sand/strokes.hpp"

namespace {

using samples::apart;
using samples::highest;
using samples::kSanitized;
using sand::kProbePerCell;
using sand::ProbePoint;

constexpr int kDigging = 20;  // [step]

// With sanitizers, all tools dig on all kinds of ground, and slide for some steps after that. Other builds compare the
// sand with that of all sweeps, and wait until it rests: hundreds of steps of the same code.
constexpr int kSlidingWithSanitizers = 12;  // [step]

struct Case {
    const char* name;
    int side = 256, radius = 30;  // [cell]
    sand::Rim rim = sand::Rim::closed;
    double middle = 0.5;   // of the circle along which the hand digs, from west to east [field]
    double rockDepth = 0;  // [cell]; 0: no rock
    int wall = -1;         // column; -1: no wall
    double band = 0.001;
    double mostApart = 0.035;  // at rest, beside all sweeps
};

scene::Scene sceneOf(const Case& given) {
    scene::Scene scene = samples::flatScene(given.side, given.side, given.radius);
    sand::Tuning& tuning = scene.rules.tuning;
    tuning.threshold = 44204;  // 34 degrees
    tuning.startThreshold = static_cast<std::int32_t>(44204 * (1 + given.band));
    tuning.sweepsPerStep = (given.radius * given.radius + 5) / 6;
    scene.rules.rim = given.rim;
    if (given.rockDepth > 0 || given.wall >= 0) {
        auto ground = std::make_shared<sand::Ground>(given.side, given.side);
        for (int y = 0; y < given.side; ++y) {
            for (int x = 0; x < given.side && given.rockDepth > 0; ++x) {
                const double depth = given.rockDepth * (1 + 0.5 * std::sin(x / 30.0) * std::cos(y / 23.0));
                ground->setBedrock(x, y, static_cast<std::int32_t>(-depth * sand::kUnitsPerCell));
            }
            if (given.wall >= 0) {
                ground->setWall(given.wall, y);
            }
        }
        scene.ground = ground;
        scene.rules.ground = ground->digest();
    }
    return scene;
}

/// Returns the path of a step of a hand that digs along a circle, 0.8 radii deep.
std::vector<ProbePoint> pathOf(const Case& given, int step) {
    constexpr int kSamples = 5;
    std::vector<ProbePoint> path;
    for (int sample = 0; sample < kSamples; ++sample) {
        const double turn = (step + double(sample) / kSamples) * 0.09, circle = 0.2 * given.side;
        path.push_back(sand::probePoint(given.middle * given.side + circle * std::cos(turn),
                                        given.side / 2.0 + circle * std::sin(turn), 0.2 * given.radius));
    }
    return path;
}

/// Sand in which a hand drags a tool as in pathOf(). Each drag has all sweeps of the material after it.
class FullPath {
public:
    explicit FullPath(const Case& given)
        : case_(given), scene_(sceneOf(given)), surface_(scene_.rules, scene_.terrain, scene_.ground, {}) {}

    void dig() {
        const sand::Tool& tool = scene_.rules.tuning.tool;
        for (int step = 0; step < kDigging; ++step) {
            std::vector<ProbePoint> path = pathOf(case_, step);
            path.insert(path.begin(), step == 0 ? path.front() : at_);
            surface_.drag(tool, path);
            surface_.release(tool, path.front());
            at_ = path.back();
            surface_.arrive(tool, at_);
            surface_.sweep(sand::SweepPart::all(scene_.rules.tuning.sweepsPerStep), &tool, at_);
        }
    }
    void rest() {
        surface_.release(scene_.rules.tuning.tool, at_);
        while (!surface_.sweep(sand::SweepPart::all(256), nullptr, at_).still) {
        }
    }
    [[nodiscard]] const sand::HeightField& field() const { return std::get<sand::GridData>(surface_.data()).field; }

private:
    Case case_;
    scene::Scene scene_;
    sand::grid::GridSurface surface_;
    ProbePoint at_;
};

void digWith(sand::Replica& sand, const Case& given) {
    for (int step = 0; step < kDigging; ++step) {
        sand.apply({.number = sand.stepNumber() + 1, .engaged = true, .path = pathOf(given, step)});
    }
}

/// Runs steps without a movement until all sand rests. Returns their number, or `most`.
int stepsToRest(sand::Replica& sand, int most) {
    int steps = 0;
    do {
        sand.apply({.number = sand.stepNumber() + 1, .engaged = sand.engaged()});
        ++steps;
    } while (!sand.settled() && steps < most);
    return steps;
}

const std::array kCases{
    Case{"level sand"}, Case{"another side", 253}, Case{"a closed rim", 256, 30, sand::Rim::closed, 0.15},
    Case{"an open rim", 256, 30, sand::Rim::open, 0.15}, Case{"rough rock", 256, 30, sand::Rim::closed, 0.5, 20},
    // A layer thinner than a coarse cell is less exact.
    Case{"thin layers", 256, 30, sand::Rim::closed, 0.5, 3, -1, 0.001, 0.055},
    Case{"a wall", 256, 30, sand::Rim::closed, 0.5, 0, 150},
    Case{"a wide band", 256, 30, sand::Rim::closed, 0.5, 0, -1, 0.2}};

TEST(LargeTool, DigsAsAllSweepsWould) {
    for (const Case& given : kCases) {
        SCOPED_TRACE(given.name);
        sand::Replica sand(sceneOf(given));
        FullPath full(given);
        digWith(sand, given);
        if (!kSanitized) {
            full.dig();
            EXPECT_LE(apart(samples::fieldOf(sand), full.field()), 0.05);
            EXPECT_LE(highest(samples::fieldOf(sand)), 1.35 * highest(full.field()));
        }
        sand.apply({.number = sand.stepNumber() + 1, .engaged = false});
        if (kSanitized) {
            (void)stepsToRest(sand, kSlidingWithSanitizers);
        } else {
            EXPECT_LT(stepsToRest(sand, 600), 600);
            full.rest();
            EXPECT_LE(apart(samples::fieldOf(sand), full.field()), given.mostApart);
        }
        EXPECT_EQ(sand.volume() + sand.outflow(), sceneOf(given).terrain.volume());
        EXPECT_EQ(sand.outflow() > 0, given.rim == sand::Rim::open);
    }
}

TEST(LargeTool, RestsWhileItIsHeld) {
    for (const auto& [radius, most] : {std::pair(30, 300), {61, 900}}) {
        const Case given{"held", 8 * radius, radius};
        sand::Replica sand(sceneOf(given));
        digWith(sand, given);
        if (kSanitized) {
            (void)stepsToRest(sand, kSlidingWithSanitizers);
            EXPECT_EQ(sand.volume(), sceneOf(given).terrain.volume()) << radius;
            continue;
        }
        EXPECT_LT(stepsToRest(sand, most), most) << radius;
        const sand::HeightField field = samples::fieldOf(sand);
        sand.apply({.number = sand.stepNumber() + 1, .engaged = true});
        EXPECT_TRUE(sameHeights(field, samples::fieldOf(sand)));
    }
}

/// Returns the hash after a session whose steps have at most `part` sweeps.
std::uint64_t hashInParts(std::int32_t part, const sand::grid::Erosion::Options& how, bool resumed,
                          sand::HeightField* field = nullptr) {
    const Case given{"parts"};
    sand::Replica sand = samples::replicaSwept(sceneOf(given), how);
    for (int number = 0; number < 6; ++number) {
        sand::Step step{.number = 0,
                        .engaged = number != 4,
                        .path = number % 3 == 2 ? std::vector<ProbePoint>() : pathOf(given, number)};
        do {
            step.number = sand.stepNumber() + 1;
            step.sweeps = std::min(part, sand.mostSweeps(step));
            sand.apply(step);
            EXPECT_FALSE(sand.refusedStep()) << sand.leftOut();
            if (resumed) {
                sand::Replica other = samples::replicaSwept(sceneOf(given), how);
                other.decodeState(sand.encodeState());
                sand = other;
            }
            step.path.clear();
        } while (sand.owed().any());
    }
    if (field != nullptr) {
        *field = samples::fieldOf(sand);
    }
    return sand.stateHash();
}

/// The number of the last step differs, so that only the sand is compared.
TEST(LargeTool, HasTheSameSandInParts) {
    const auto sandAfter = [](std::int32_t part) {
        sand::HeightField field(1, 1, 1.0);
        (void)hashInParts(part, {}, false, &field);
        return field;
    };
    const sand::HeightField whole = sandAfter(4096);
    for (const std::int32_t part : {1, 7, 16, 64}) {
        EXPECT_TRUE(sameHeights(sandAfter(part), whole)) << part;
    }
}

TEST(LargeTool, HasTheSameSandHoweverItIsSwept) {
    const host::WorkerPool pool(3);
    const std::uint64_t whole = hashInParts(4096, {}, false);
    for (const int block : {2, 13, 64}) {
        EXPECT_EQ(hashInParts(4096, {.blockSize = block}, false), whole) << block;
    }
    EXPECT_EQ(hashInParts(4096, {.path = base::CodePath::baseline}, false), whole);
    EXPECT_EQ(hashInParts(4096, {.executor = pool.lend()}, false), whole);
    EXPECT_EQ(hashInParts(4096, {}, true), whole) << "with a state after each step";
}

TEST(LargeTool, SlidesWhereItWas) {
    Case given{"carried away", 512};
    sand::Replica sand(sceneOf(given));
    const auto place = [](double x) { return sand::probePoint(x, 256, -20); };
    sand.apply({.number = 1, .engaged = true, .path = {place(100)}});
    // The tool is lifted and carried away. Walls of sand stay behind it, and 8 sweeps alone would hardly lower them.
    scene::Scene scene = sceneOf(given);
    scene.terrain = samples::fieldOf(sand);
    sand::grid::GridSurface swept(scene.rules, scene.terrain, nullptr, {});
    sand.apply({.number = 2, .engaged = false, .path = {place(400)}});
    swept.sweep(sand::SweepPart::all(8), nullptr, place(100));
    EXPECT_LT(sand.surface().heights().highest, 0.9 * swept.heights().highest);
}

TEST(LargeTool, IsUndone) {
    const Case given{"undone", 256, 30, sand::Rim::open, 0.15, 20};
    sand::Replica sand(sceneOf(given));
    const sand::HeightField before = samples::fieldOf(sand);
    digWith(sand, given);
    EXPECT_FALSE(sameHeights(before, samples::fieldOf(sand)));
    sand.apply({.number = sand.stepNumber() + 1, .engaged = false, .edit = sand::Edit::undo});
    EXPECT_TRUE(sameHeights(before, samples::fieldOf(sand)));
    EXPECT_EQ(sand.outflow(), 0);
}

/// The patch reaches into a tile of the undo that the tool does not touch.
TEST(LargeTool, IsUndoneWhereOnlyItsCoarsePhaseMovesSand) {
    scene::Scene scene = sceneOf({"undone"});
    for (int y = 120; y < 136; ++y) {
        for (int x = 193; x < 201; ++x) {
            scene.terrain.setHeight(x, y, 30 * sand::kUnitsPerCell);
        }
    }
    sand::Replica sand(scene);
    sand.apply({.number = 1, .engaged = true, .path = {sand::probePoint(140, 128, 0)}});
    EXPECT_LT(samples::fieldOf(sand).height(196, 128), 28 * sand::kUnitsPerCell);
    sand.apply({.number = 2, .engaged = false, .edit = sand::Edit::undo});
    EXPECT_TRUE(sameHeights(samples::fieldOf(sand), scene.terrain));
}

TEST(LargeTool, SlidesAfterItIsReplacedOrTurned) {
    Case given{"edits"};
    scene::Scene scene = sceneOf(given);
    sand::Replica sand(scene);
    sand.apply({.number = 1, .engaged = true, .path = {sand::probePoint(128, 128, 40)}});
    EXPECT_EQ(sand.lastWork().sweeps, 1) << "the tool hovers above sand at rest";
    sand::Tuning tuning = scene.rules.tuning;
    tuning.tool = {sand::ToolKind::ellipsoid, 40 * kProbePerCell, 20 * kProbePerCell};
    tuning.sweepsPerStep = 267;
    sand::Step tune{.number = 2, .engaged = true, .edit = sand::Edit::tuned(tuning)};
    EXPECT_EQ(sand.mostSweeps(tune), 8) << "the new tool presses";
    sand.apply(tune);
    sand::Step turn{.number = 3, .engaged = true};
    EXPECT_EQ(sand.mostSweeps(turn), 40) << "nothing moves";
    turn.heading = sand::Heading{0, 16384, false};
    EXPECT_EQ(sand.mostSweeps(turn), 8);
    tune = {.number = 3, .engaged = false, .edit = sand::Edit::tuned(scene.rules.tuning)};
    EXPECT_EQ(sand.mostSweeps(tune), 8) << "the tool is lifted";
}

}  // namespace
