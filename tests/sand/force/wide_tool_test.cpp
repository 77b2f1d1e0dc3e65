// SPDX-License-Identifier: Apache-2.0
// A tool that is many cells wide feels the cells themselves.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <vector>

#include "sand/force/law.hpp"
#include "sand/replica.hpp"
#include "sand/tin/refine/start_maker.hpp"
#include "tests/sand/force/force_samples.hpp"

namespace {

using namespace sand::force;
using namespace samples;

/// Level sand from which a sphere was dug to its middle, with the heap around it. A wall of one cell thickness is
/// directly below the control points, which is the hardest place to read.
struct Bowl {
    int radius;     // [cell]
    double middle;  // position of the middle from the west [cell]; it is 5 radii from the south
    sand::HeightField field;

    Bowl(int cells, double aside) : radius(cells), middle(5 * cells + aside), field(10 * cells, 10 * cells, kCell) {
        // Farther than 1.5 R from the middle, the sand is level at height 0.
        const auto first = [cells](double from) { return static_cast<int>(from - 1.5 * cells); };
        for (int row = first(5 * cells); row < first(8 * cells); ++row) {
            for (int column = first(middle); column < first(middle + 3 * cells); ++column) {
                const double r = std::hypot(column + 0.5 - middle, row + 0.5 - 5 * radius);
                const double height = r < radius ? -std::sqrt(radius * radius - r * r)
                                                 : std::max(0.0, 0.3 * radius - 0.67 * (r - radius));
                field.setHeight(column, row, static_cast<std::int32_t>(std::lround(height * sand::kUnitsPerCell)));
            }
        }
    }
    [[nodiscard]] Vec3 place() const { return {middle * kCell, 5 * radius * kCell, 0}; }
    [[nodiscard]] Contour tool() const { return Contour::sphere(radius * kCell); }
    [[nodiscard]] Response felt(const sand::ForceConstants& constants) const {
        return respond(constants, {field, probeAt(place()), radius * kCell}, tool(), place());
    }
    /// Returns the height between the middles of four cells [scene unit].
    [[nodiscard]] double height(double x, double y /* [scene unit] */) const {
        const double column = x / kCell - 0.5, row = y / kCell - 0.5;
        const int i = static_cast<int>(column), j = static_cast<int>(row);
        const double u = column - i, v = row - j;
        return kCell / sand::kUnitsPerCell *
               ((1 - v) * ((1 - u) * field.height(i, j) + u * field.height(i + 1, j)) +
                v * ((1 - u) * field.height(i, j + 1) + u * field.height(i + 1, j + 1)));
    }
    /// Returns the push upwards of Purchart et al. 2012: F_M / N Σ dh of 32 points. The sand is far above all of them.
    [[nodiscard]] double pointsByCells(const sand::ForceConstants& constants) const {
        double sum = 0;
        for (int i = 0; i < 32; ++i) {
            const double angle = 2 * std::numbers::pi * i / 32, reach = radius * kCell;
            sum += height(place().x + reach * std::cos(angle), place().y + reach * std::sin(angle)) + reach;
        }
        return constants.maxForce / 32 * sum / constants.unitLength;
    }
    /// Returns the depth of Dorjgotov et al. 2007, as the mean of many places of the ring.
    [[nodiscard]] double depthByCells() const {
        constexpr int kCircles = 60, kRays = 360;
        double sum = 0;
        for (int circle = 0; circle < kCircles; ++circle) {
            const double reach = radius * kCell * std::sqrt(1 + 3 * (circle + 0.5) / kCircles);
            for (int ray = 0; ray < kRays; ++ray) {
                const double angle = 2 * std::numbers::pi * ray / kRays;
                sum += height(place().x + reach * std::cos(angle), place().y + reach * std::sin(angle));
            }
        }
        return sum / (kCircles * kRays) + radius * kCell;
    }
};

constexpr std::array kAsides{0.0, 0.25, 0.5, 0.8};  // [cell]

/// Returns the same sand on a TIN with a vertex in the middle of every cell. There are too many triangles around the
/// tool to copy them.
sand::Replica finelyMeshed(const Bowl& bowl) {
    sand::Start start;
    start.terrain = sand::HeightField(1, 1, kCell);
    start.tin = std::make_shared<const sand::tin::TinStart>(
        sand::tin::follow(
            bowl.field, nullptr,
            {.widest = sand::kProbePerCell, .maxError = 0, .mostVertices = 2 * 100 * bowl.radius * bowl.radius})
            .start);
    start.rules.columns = bowl.field.columns();
    start.rules.rows = bowl.field.rows();
    start.rules.tuning.threshold = start.rules.tuning.startThreshold = sand::kUnitsPerCell;
    start.rules.tuning.sweepsPerStep = 1;
    start.rules.stepsPerSecond = 60;
    start.rules.tuning.tool.radius = bowl.radius * sand::kProbePerCell;
    return sand::Replica(start);
}

/// Returns the relative error of the push of Purchart et al. 2012, at the worst of several places between cells.
double worstOfPoints(int cells) {
    double worst = 0;
    for (const double aside : kAsides) {
        const Bowl bowl(cells, aside);
        const sand::ForceConstants constants = constantsOf(sand::ForceLaw::controlPoints);
        const double exact = bowl.pointsByCells(constants);
        worst = std::max(worst, std::abs(bowl.felt(constants).push.z - exact) / exact);
    }
    return worst;
}

// A float represents a height of one radius with a relative error of 6e-8.
TEST(WideTool, ControlPointsFeelEveryCell) {
    for (const int cells : {5, 11, 12, 31, 127}) {
        EXPECT_LT(worstOfPoints(cells), 1e-6) << cells << " cells";
    }
}

// The ring's 144 places are a sample. Its error is at most 1 % on this bowl, with any radius.
TEST(WideTool, TheRingFeelsEveryCell) {
    for (const int cells : {11, 31, 127}) {
        for (const double aside : kAsides) {
            const Bowl bowl(cells, aside);
            const Contact contact =
                measureContact({bowl.field, probeAt(bowl.place()), cells * kCell}, bowl.place(), bowl.tool());
            EXPECT_NEAR(contact.depth.value, bowl.depthByCells(), 0.01 * bowl.depthByCells()) << cells << " cells";
        }
    }
}

/// Spheres of these radii, with the error of the push that docs/forces.md states for them.
struct Stated {
    std::vector<int> cells;
    double error;
};

// The patch samples every second to seventh cell. The bowl's wall is 0.4 R high. A control point reads it at a random
// place, so that the error of a mean of 32 points does not shrink with the radius. The radii include the worst of 200
// that were tried from 128 to 1024.
TEST(WideTool, OverAHundredAndTwentySevenCellsItIsFeltWithinTheBound) {
    for (const auto& [radii, error] : {Stated{{128, 180, 193, 255, 256}, 0.07}, Stated{{258, 400, 512, 768}, 0.10}}) {
        double worst = 0;
        for (const int cells : radii) {
            const double here = worstOfPoints(cells);
            std::printf("a sphere of %d cells: %.2f %% off\n", cells, 100 * here);
            worst = std::max(worst, here);
        }
        EXPECT_LT(worst, error);
        EXPECT_GT(worst, 0.8 * error) << "the document must not state more than it has to";
    }
}

// On a TIN, the outline is the foot of the cut. Control points lie half a cell outside it.
double worstOnFineTin(int cells) {
    double worst = 0;
    for (const double aside : kAsides) {
        const Bowl bowl(cells, aside);
        const sand::Replica replica = finelyMeshed(bowl);
        const sand::ForceConstants constants = constantsOf(sand::ForceLaw::controlPoints);
        SurfacePatch patch;
        patch.take(replica.surface(), replica.rules(), replica.cellSize(), probeAt(bowl.place()));
        EXPECT_TRUE(patch.facets().empty());
        double sum = 0;
        for (int i = 0; i < 32; ++i) {
            const double angle = 2 * std::numbers::pi * i / 32, reach = cells + 0.5;
            const double x = bowl.middle + reach * std::cos(angle), y = 5 * cells + reach * std::sin(angle);
            sum += kCell *
                   (replica.surface().height(sand::kProbePerCell * x, sand::kProbePerCell * y) / sand::kUnitsPerCell +
                    cells);
        }
        const double exact = constants.maxForce / 32 * sum / constants.unitLength;
        const double felt = respond(constants, patch, bowl.tool(), bowl.place()).push.z;
        worst = std::max(worst, std::abs(felt - exact) / exact);
    }
    return worst;
}

// 96 heights on a side are R/12 apart with any radius. The wall is as wide as that.
TEST(WideTool, OnAFineTinItIsFeltWithinTheBound) {
    for (const auto& [radii, error] :
         {Stated{{6, 8, 11}, 0.01}, Stated{{12, 31}, 0.10}, Stated{{26, 36}, 0.14}, Stated{{41}, 0.20}}) {
        for (const int cells : radii) {
            const double here = worstOnFineTin(cells);
            std::printf("a sphere of %d cells on a fine TIN: %.2f %% off\n", cells, 100 * here);
            EXPECT_LT(here, error) << cells << " cells";
        }
    }
}

}  // namespace
