// SPDX-License-Identifier: Apache-2.0
// Drags of a tool with a coarse phase at borders, beside their mirror images.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/support/borders/border_scenes.hpp"

namespace {

using borders::Case;

using sand::ToolKind;

struct Experiment {
    std::string name;
    Case field;
    double x;            // of the drag, which goes from south to north [cell from the west]
    double length = 42;  // of the drag [cell]
};

/// Returns level sand for a tool of 61 cells. Coarse cells do not divide its sides.
Case level(ToolKind kind) {
    Case field;
    field.columns = 233;
    field.rows = 201;
    field.tool = kind;
    field.radius = 61;
    field.sweeps = (61 * 61 + 5) / 6;
    return field;
}

/// Returns the mirror image of a field, in which west is east.
Case mirrored(const Case& field) {
    Case image = field;
    const int columns = field.columns;
    image.height = [=](double x, double y) { return field.height(columns - x, y); };
    if (field.wall) {
        image.wall = [=](int x, int y) { return field.wall(columns - 1 - x, y); };
    }
    if (field.rock) {
        image.rock = [=](double x, double y) { return field.rock(columns - x, y); };
    }
    return image;
}

/// Drags a tool from south to north, 0.8 radii deep, and lifts it. Returns the heights ten steps later. With `image`,
/// the tool itself is mirrored, too.
std::vector<double> drag(const Case& field, double x, double length, bool image) {
    scene::Scene scene = borders::sceneOf(field);
    sand::Heading& heading = scene.rules.tuning.tool.heading;
    heading.x = static_cast<std::int16_t>(image ? -heading.x : heading.x);
    heading.mirrored = image;
    sand::Replica sand(scene);
    EXPECT_TRUE(sand.hasCoarsePhase({.engaged = true}));
    borders::Hand hand(sand);
    for (int way = 0; way <= length; way += 7) {
        hand.press(x, 60 + way, 8 + 0.2 * field.radius);
    }
    for (int step = 0; step < 10; ++step) {
        hand.hover();
    }
    return borders::heightsOf(sand);
}

/// Returns the volume by which a drag and its mirror image differ, as a share of the sand that the drag moves.
double apartFromMirror(const Experiment& given) {
    const int columns = given.field.columns;
    const std::vector<double> sand = drag(given.field, given.x, given.length, false);
    std::vector<double> image = drag(mirrored(given.field), columns - given.x, given.length, true);
    for (auto row = image.begin(); row != image.end(); row += columns) {
        std::reverse(row, row + columns);
    }
    const std::vector<double> start = borders::heightsOf(sand::Replica(borders::sceneOf(given.field)));
    return borders::moved(sand, image) / borders::moved(start, sand);
}

/// The centre of the tool is in the middle of a cell.
std::vector<Experiment> experiments() {
    const auto kind = ToolKind::sphere;
    std::vector<Experiment> all{{"a closed rim", level(kind), 20.5},
                                {"half outside a closed rim", level(kind), 0.5},
                                {"an open rim", level(kind), 20.5},
                                {"a wall", level(kind), 70.5},
                                {"a rock face", level(kind), 70.5},
                                {"rough rock", level(kind), 70.5},
                                {"a foot at a closed rim", level(ToolKind::footprint), 20.5}};
    all[2].field.rim = sand::Rim::open;
    all[3].field.wall = [](int x, int) { return x == 40; };
    all[4].field.rock = [](double x, double) { return x < 40 ? 60.0 : -100.0; };
    all[5].field.rock = [](double x, double y) { return 6 * std::sin(x / 9) * std::cos(y / 7) - 4; };
    return all;
}

// Only the odd units of each coarse cell's change differ, and what follows from them.
TEST(MirroredLargeTool, AtABorderLeavesTheMirroredSand) {
    for (const Experiment& given : experiments()) {
        EXPECT_LT(apartFromMirror(given), 1e-5) << given.name;
    }
}

// The patch lies around the cell that begins at the centre of the tool. So it is a cell farther east in the image if
// the centre is between two cells. Coarse cells of a tool in the middle of the field are counted from the western rim
// in both.
TEST(MirroredLargeTool, BetweenTwoCellsOrRimsLeavesAlmostTheMirroredSand) {
    EXPECT_LT(apartFromMirror({"between two cells", level(ToolKind::sphere), 20, 84}), 0.005);
    EXPECT_LT(apartFromMirror({"in the middle", level(ToolKind::sphere), 116.5}), 0.008);
}

}  // namespace
