// SPDX-License-Identifier: Apache-2.0
// Tools with a coarse phase on the highest, steepest, thinnest and narrowest sand that a scene may have.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "scene/model/material.hpp"
#include "tests/sand/coarse/limits.hpp"
#include "tests/support/borders/border_scenes.hpp"

namespace {

using borders::Case;
using borders::Hand;

struct Trial {
    std::string name;
    Case field{};
    std::vector<std::pair<std::string_view, double>> numbers{};  // of the material, by their words
    bool stays = false;                                          // whether no coarse phase may move sand
    int rests = 300;  // steps within which all sand rests behind a tool of 61 cells; 0: they would take too long here
};

constexpr double kMost = 1.0 * sand::kMaxHeight / sand::kUnitsPerCell;  // [cell]
constexpr int kDrags = 4;                                               // [step]

/// Returns a field whose sides coarse cells do not divide.
Case fieldOf(std::function<double(double, double)> height) {
    Case field;
    field.columns = 129;
    field.rows = 111;
    field.height = std::move(height);
    return field;
}

bool isEachSeventh(double x, double y) { return static_cast<int>(x) % 7 == 3 && static_cast<int>(y) % 7 == 3; }

/// Heights at both ends of their range.
void addHeights(std::vector<Trial>& trials) {
    trials.push_back({"a cliff", fieldOf([](double x, double) { return x < 65 ? kMost : -kMost; }), {}, false, 700});
    trials.push_back({"needles", fieldOf([](double x, double y) { return isEachSeventh(x, y) ? kMost : 0; })});
    trials.push_back({"pits", fieldOf([](double x, double y) { return isEachSeventh(x, y) ? -kMost : 0; })});
    trials.push_back({"the greatest height", fieldOf([](double, double) { return kMost; })});
    trials.push_back({"the least height", fieldOf([](double, double) { return -kMost; })});
    const std::size_t closed = trials.size();
    for (std::size_t i = 0; i < closed; ++i) {
        trials.push_back(trials[i]);
        trials.back().name += ", open rim";
        trials.back().field.rim = sand::Rim::open;
        trials.back().rests = i == 0 ? 0 : 300;
    }
}

/// Materials at the ends of what a scene may have.
void addMaterials(std::vector<Trial>& trials) {
    const Case steps = fieldOf([](double x, double y) { return static_cast<int>(x / 20 + y / 20) % 2 == 0 ? 30 : 0; });
    trials.push_back({"talus 0", steps, {{"talus", 0}}, false, 0});
    trials.push_back({"talus below 90 degrees", steps, {{"talus", 89.999999}}, true});
    trials.push_back({"no band", steps, {{"band", 0}}});
    trials.push_back({"the widest band", steps, {{"band", 1}}});
    trials.push_back({"wet", steps, {{"humidity", 1}}});
    trials.push_back({"wet and cohesive", steps, {{"humidity", 1}, {"cohesion", 1e9}}, true});
    trials.push_back({"the shortest settling time", steps, {{"settling-time", 0.001}}});
    trials.push_back({"a long settling time", steps, {{"settling-time", 1}}});
}

/// Sand thinner than a coarse cell, and ground narrower than one.
void addThinAndNarrow(std::vector<Trial>& trials) {
    for (const double thickness : {1.0 / sand::kUnitsPerCell, 0.5, 2.5}) {
        Case layer = fieldOf({});
        layer.rock = [](double x, double y) { return 12 * std::sin(x / 9) * std::cos(y / 7); };
        layer.height = [thickness, rock = layer.rock](double x, double y) { return rock(x, y) + thickness; };
        trials.push_back({fmt::format("a layer of {} cells", thickness), layer});
    }
    Case holes = fieldOf([](double, double) { return 8; });
    holes.rock = [](double x, double y) { return isEachSeventh(x, y) ? -kMost : 0; };
    trials.push_back({"rock with pits of one cell", holes});
    Case wells = fieldOf([](double, double) { return 8; });
    wells.wall = [](int x, int y) { return x > 60 && !isEachSeventh(x, y); };
    trials.push_back({"wells of one cell in walls", wells});
    for (const auto& [columns, rows] : {std::pair(1, 111), {129, 1}, {3, 111}, {129, 5}}) {
        for (const sand::Rim rim : {sand::Rim::closed, sand::Rim::open}) {
            Case narrow = fieldOf([](double x, double y) { return x + y < 60 ? 20 : -20; });
            narrow.columns = columns;
            narrow.rows = rows;
            narrow.rim = rim;
            trials.push_back({fmt::format("{} x {} cells, rim {}", columns, rows, base::nameOf(rim)), narrow});
        }
    }
}

scene::Scene sceneOf(const Trial& trial, double radius) {
    scene::Scene scene = borders::sceneOf(trial.field);
    const scene::MaterialGrid grid{scene.rules.scheme, scene.rules.stepsPerSecond, 1.0,
                                   std::max(scene.rules.columns, scene.rules.rows)};
    scene::Material material;
    material.toolRadius = radius;
    for (const auto& [word, value] : trial.numbers) {
        material = scene::withNumber(material, word, value, grid);
    }
    scene.rules.tuning = scene::tuningOf(material, grid);
    return scene;
}

/// Drags a tool through the middle of the field, `depth` below its height 0, and lifts it. Expects that all sand rests
/// within `most` steps, if this is not 0.
void digAndRest(const Trial& trial, double radius, double depth, int most) {
    const scene::Scene scene = sceneOf(trial, radius);
    sand::Replica sand(scene);
    for (int step = 0; step <= kDrags && !testing::Test::HasFailure(); ++step) {
        sand::Step drag{.number = 0, .engaged = step < kDrags};
        for (int sample = 0; sample < 4 && drag.engaged; ++sample) {
            const double way = 0.3 + 0.4 * (step + sample / 4.0) / kDrags;
            drag.path.push_back(borders::probeAt(way * trial.field.columns, 0.5 * trial.field.rows, radius - depth));
        }
        EXPECT_FALSE(coarse::applyWithinLimits(sand, scene, drag) && trial.stays);
    }
    EXPECT_TRUE(Hand(sand).rest(most) || most == 0);
    EXPECT_EQ(sand.leftOut(), "");
    EXPECT_EQ(sand.volume() + sand.outflow(), scene.terrain.volume());
}

std::vector<Trial> everyTrial() {
    std::vector<Trial> trials;
    addHeights(trials);
    addMaterials(trials);
    addThinAndNarrow(trials);
    return trials;
}

TEST(ExtremeLargeTool, KeepsVolumeRangeAndRockAndLetsTheSandRest) {
    for (const Trial& trial : everyTrial()) {
        SCOPED_TRACE(trial.name);
        digAndRest(trial, 61, 24, trial.rests);
    }
}

// The coarsest cells are 128 cells wide. With an open rim, each press takes a third of a second.
TEST(ExtremeLargeTool, OfTheGreatestRadiusKeepsThemToo) {
    for (Trial trial : everyTrial()) {
        SCOPED_TRACE(trial.name);
        if (trial.field.rim == sand::Rim::closed) {
            const bool narrow = std::min(trial.field.columns, trial.field.rows) < 10;
            trial.field.columns *= narrow ? 1 : 2;
            trial.field.rows *= narrow ? 1 : 2;
            digAndRest(trial, 2048, 2, trial.rests == 300 ? 40 : 0);
        }
    }
}

}  // namespace
