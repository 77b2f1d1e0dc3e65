// SPDX-License-Identifier: Apache-2.0
// Tests the reach of changes of sand and tool in the picture, and the number of heights that are read for them. The
// picture that is drawn in parts must be equal to the whole one in every byte.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <vector>

#include "scene/model/scene.hpp"
#include "tests/support/pictures/redraw_fixture.hpp"

namespace {

using render_node::EyeTarget;
using render_node::PixelRect;
using render_node::ScenePainter;
using sample::Pixels;
using sample::Redraw;

/// Returns the smallest rectangle around all pixels that differ.
PixelRect difference(const Pixels& a, const Pixels& b, int width) {
    PixelRect found{};
    const int height = static_cast<int>(a.size()) / 3 / width;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            if (sample::pixel(a, width, x, y) != sample::pixel(b, width, x, y)) {
                found = around(found, {x, height - 1 - y, x + 1, height - y});
            }
        }
    }
    return found;
}

/// Returns the distance of a change from the nearest edge of the rectangle that is inside the picture [pixel].
int slack(const PixelRect& drawn, const PixelRect& changed, const EyeTarget& target) {
    int least = 1000;
    const auto edge = [&](bool within, int gap) { least = within ? std::min(least, gap) : least; };
    edge(drawn.x0 > 0, changed.x0 - drawn.x0);
    edge(drawn.y0 > 0, changed.y0 - drawn.y0);
    edge(drawn.x1 < target.width(), drawn.x1 - changed.x1);
    edge(drawn.y1 < target.height(), drawn.y1 - changed.y1);
    return least;
}

// Both corners of the field change. A rectangle around them would be the whole field.
TEST_F(Redraw, ReadsOnlyWhatIsListedAndWhatLiesAroundIt) {
    scene::Scene scene = sample::flatScene(512, 512);
    ScenePainter view(scene, glm::dmat4(1));
    for (const int corner : {100, 400}) {
        scene.terrain.setHeight(corner, corner, sand::kUnitsPerCell);
    }
    const std::int64_t before = view.placesRead();
    view.update(sand::GridData{scene.terrain},
                {.whole = false, .parts = sand::CellChange{{{96, 96, 104, 104}, {400, 400, 408, 408}}}});
    // For each of two blocks of 64 cells, reads the cells around it within reach of light (10 cells) and of a triangle
    // of level 2 (4 cells): 29 × 29 cells. Also reads the heights of at most nine chunks of 17 × 17 cells.
    EXPECT_LT(view.placesRead() - before, 2 * (64 + 29 * 29 + 9 * 17 * 17));
    EXPECT_GE(view.placesRead() - before, 2 * 64);
}

// Seen from the side, a post of 30 cells hides sand far behind it.
TEST_F(Redraw, ErasesAPostThatIsGone) {
    scene::Scene scene = sample::flatScene(128, 128);
    scene.terrain.setHeight(64, 30, 30 * sand::kUnitsPerCell);
    ScenePainter view(scene, glm::dmat4(1));
    const render_node::Camera beside = sample::camera({1, -1.2, 0.7}, {1, 1, 0});
    const EyeTarget inParts(200, 150), whole(200, 150);
    render_node::EyeMemory memory;
    view.drawIfChanged(beside, inParts, memory);
    scene.terrain.setHeight(64, 30, 0);
    view.update(sand::GridData{scene.terrain}, sample::changeOf({64, 24, 72, 32}));
    const PixelRect drawn = view.drawIfChanged(beside, inParts, memory);
    EXPECT_LT(drawn.area(), 200 * 150);
    EXPECT_TRUE(inParts.read() == sample::draw(view, beside, whole));
}

// The changes of a session fade out before the edge of the rectangle that may change. Posts on level sand hide the sky
// as far away as sand can. So the test finds a rectangle that is two pixels too small on any side.
TEST_F(Redraw, ReachesAsFarAsAPostHidesTheSkyAndNotMuchFurther) {
    scene::Scene scene = sample::flatScene(128, 128);
    ScenePainter view(scene, glm::dmat4(1));
    const render_node::Camera above = sample::camera({1, 1, 2.2}, {1, 1, 0});
    const EyeTarget inParts(200, 150), whole(200, 150);
    render_node::EyeMemory memory;
    view.drawIfChanged(above, inParts, memory);
    Pixels before = inParts.read();
    int least = 1000;
    for (int i = 0; i < 24; ++i) {
        const int column = 30 + (i * 37) % 68, row = 40 + (i * 23) % 48;
        scene.terrain.setHeight(column, row, 5 * sand::kUnitsPerCell);
        view.update(sand::GridData{scene.terrain}, sample::changeOf({column - 7, row - 3, column + 5, row + 9}));
        const PixelRect drawn = view.drawIfChanged(above, inParts, memory);
        const Pixels now = sample::draw(view, above, whole);
        ASSERT_TRUE(inParts.read() == now) << "post " << i;
        ASSERT_LT(drawn.area(), 100 * 75) << "post " << i;
        least = std::min(least, slack(drawn, difference(before, now, 200), whole));
        before = now;
    }
    std::printf("the nearest change was %d pixels from the edge\n", least);
    EXPECT_LE(least, 2);
}

// Tests the usual sun, a sun in the zenith and a sun with long shadows. Also tests a sun that is too low for its
// shadows to be bounded closely.
TEST_F(Redraw, FollowsAToolHighAboveTheSandAndItsShadow) {
    for (const std::vector<double>& sun :
         std::vector<std::vector<double>>{scene::Look{}.sunDirection, {0, 0, 1}, {-0.6, 0.7, 0.3}, {0.9, -0.4, 0.1}}) {
        scene::Scene scene = sample::flatScene(128, 128, 0.05);
        scene.look.sunDirection = sun;
        ScenePainter view(scene, glm::dmat4(1));
        const render_node::Camera above = sample::camera({1, 1, 2.2}, {1, 1, 0});
        const EyeTarget inParts(200, 150), whole(200, 150);
        render_node::EyeMemory memory;
        view.drawIfChanged(above, inParts, memory);
        for (int i = 0; i < 40; ++i) {
            view.setTool(sample::probeAt(scene, {0.3 + 0.035 * i, 0.4 + 0.03 * i, 0.02 + 0.02 * i}), i % 2 == 0);
            const PixelRect drawn = view.drawIfChanged(above, inParts, memory);
            EXPECT_LT(drawn.area(), 200 * 150);
            ASSERT_TRUE(inParts.read() == sample::draw(view, above, whole)) << "sun " << sun[2] << ", place " << i;
        }
        EXPECT_TRUE(view.drawIfChanged(above, inParts, memory).empty());
    }
}

TEST_F(Redraw, FollowsAToolThatChangesItsSizeWhereItIs) {
    const scene::Scene scene = sample::flatScene(128, 128, 0.05);
    ScenePainter view(scene, glm::dmat4(1));
    const render_node::Camera above = sample::camera({1, 1, 2.2}, {1, 1, 0});
    const EyeTarget inParts(200, 150), whole(200, 150);
    render_node::EyeMemory memory;
    const sand::ProbePoint place = sample::probeAt(scene, {0.8, 0.9, 0.1});
    Pixels before;
    for (const double radius : {0.05, 0.12, 0.02, 0.08}) {
        const auto probes = static_cast<std::int32_t>(radius / scene.terrain.cellSize() * sand::kProbePerCell);
        view.setTool(place, true, {.radius = probes});
        view.drawIfChanged(above, inParts, memory);
        const Pixels now = inParts.read();
        ASSERT_TRUE(now == sample::draw(view, above, whole)) << "radius " << radius;
        EXPECT_FALSE(now == before) << "radius " << radius;
        before = now;
    }
    EXPECT_TRUE(view.drawIfChanged(above, inParts, memory).empty());
}

// Tools of every shape are lifted, dragged, turned on the spot and switched while they are in the sand. They are also
// low over the rim, so that the boards take their shadow.
TEST_F(Redraw, FollowsToolsOfEveryShapeAsTheyTurnAndAreSwitched) {
    scene::Scene scene = sample::duneScene(128);
    scene.rules.tuning.tool.radius = static_cast<std::int32_t>(0.14 / scene.terrain.cellSize() * sand::kProbePerCell);
    sand::Replica replica(scene);
    ScenePainter view(scene, glm::dmat4(1));
    const render_node::Camera slanted = sample::camera({1, -0.9, 1.3}, {1, 0.9, 0});
    const EyeTarget inParts(200, 150), whole(200, 150);
    render_node::EyeMemory memory;
    int inPart = 0;
    for (int i = 0; i < 120; ++i) {
        sand::Step step{.epoch = 1, .number = replica.stepNumber() + 1, .engaged = i % 20 >= 6, .path = {}};
        const double along = (i % 40) / 40.0, height = step.engaged ? 0.16 : 0.3 + 0.02 * (i % 20);
        const int row = i / 20;
        if (i % 20 < 15) {
            step.path = {sample::probeAt(scene, {0.3 + 1.75 * along, 0.5 + 0.1 * row, height})};
        }
        step.heading = sand::headingOf(7.0 * i, i % 3 == 0);
        if (i % 10 == 8) {
            sand::Tuning tuning = scene.rules.tuning;
            tuning.tool.kind = static_cast<sand::ToolKind>((i / 10) % sand::kToolKinds);
            tuning.tool.halfWidth = sand::isRound(tuning.tool.kind) ? 0 : tuning.tool.radius / 3;
            step.edit = sand::Edit::tuned(tuning);
        }
        replica.apply(step);
        view.update(replica.surface().data(), replica.takeChange());
        view.setTool(replica.probe(), replica.engaged(), replica.tool());
        const PixelRect drawn = view.drawIfChanged(slanted, inParts, memory);
        inPart += !drawn.empty() && drawn.area() < 200 * 150 ? 1 : 0;
        ASSERT_TRUE(inParts.read() == sample::draw(view, slanted, whole))
            << base::nameOf(replica.tool().kind) << " in step " << i;
    }
    EXPECT_GT(inPart, 60);
}

TEST_F(Redraw, OfRestingSandDrawsNothing) {
    const scene::Scene scene = sample::flatScene(64, 64);
    sand::Replica replica(scene);
    ScenePainter view(scene, glm::dmat4(1));
    const render_node::Camera above = sample::camera({1, 1, 2.2}, {1, 1, 0});
    const EyeTarget target(200, 150);
    render_node::EyeMemory memory;
    for (int i = 0; i < 5; ++i) {
        replica.apply({0, replica.stepNumber() + 1, false, {}});
        view.update(replica.surface().data(), replica.takeChange());
        view.setTool(replica.probe(), replica.engaged());
        EXPECT_EQ(view.drawIfChanged(above, target, memory).empty(), i > 0) << "frame " << i;
    }
}

}  // namespace
