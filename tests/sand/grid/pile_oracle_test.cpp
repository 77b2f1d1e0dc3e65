// SPDX-License-Identifier: Apache-2.0
// Cylinders of sand, and the piles that they must become (oracles.hpp, O1).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "tests/support/sand/oracles.hpp"
#include "tests/support/sand/reference_sweep.hpp"
#include "tests/support/sand/relaxing.hpp"

namespace {

using oracles::Cylinder;
using samples::Law;
using samples::nameOf;
using sand::HeightField;

struct Pile {
    HeightField field;
    oracles::Distance distance;
};

/// Returns a cylinder in the middle of an n x n field.
HeightField cylinderOn(int n, const Cylinder& cylinder) {
    const double middle = n / 2.0;
    return oracles::fieldOf(n, n, oracles::around(middle, middle, [&](double r) { return cylinder.start(r); }));
}

/// Returns the distance of a field at rest from the pile that the cylinder in its middle must become.
oracles::Distance distanceToRest(const HeightField& field, const Cylinder& cylinder) {
    const int n = field.columns();
    const double middle = n / 2.0;
    return oracles::distance(
        field, oracles::sampled(n, n, oracles::around(middle, middle, [&](double r) { return cylinder.rest(r); })));
}

Pile settledCylinder(int n, const Cylinder& cylinder, const Law& law) {
    HeightField field = cylinderOn(n, cylinder);
    samples::relax(field, samples::rulesFor(field, law));
    return {field, distanceToRest(field, cylinder)};
}

/// Returns a pile of a cylinder whose radius is a quarter of the field, and whose height is 0.6 of the radius. It
/// settles only once, although several tests of one process use it.
const Pile& lowPile(int n, const Law& law) {
    static std::map<std::pair<int, Law>, Pile> piles;
    const auto found = piles.find({n, law});
    return found != piles.end()
               ? found->second
               : piles.emplace(std::pair{n, law}, settledCylinder(n, {0.25 * n, 0.15 * n}, law)).first->second;
}

// A prototype came within 0.22 %, 0.059 % and 0.023 % of the frustum at N = 64, 128 and 256.
TEST(PileOracle, LowCylinderBecomesItsFrustum) {
    for (const Law& law : samples::laws()) {
        EXPECT_LE(lowPile(64, law).distance.misplaced, 0.003) << nameOf(law);
        EXPECT_LE(lowPile(128, law).distance.misplaced, 0.001) << nameOf(law);
        EXPECT_LE(lowPile(256, law).distance.misplaced, 0.0004) << nameOf(law);
    }
}

// Only with inertia, because without it the pile takes 25,000 sweeps.
TEST(PileOracle, LowCylinderOn512CellsIsRightWithinOneIn5000) {
    for (const Law& law : samples::laws()) {
        if (law.inertial()) {
            EXPECT_LE(lowPile(512, law).distance.misplaced, 0.0002) << nameOf(law);
        }
    }
}

/// Returns the share that is misplaced at kinks. The kink at the end of a slope is rounded over one or two cells. This
/// misplaces a cross-section of some fixed size per cell of the kink's length, on every grid. 0.05 to 0.25 cells² were
/// measured.
double misplacedAtKinks(const Cylinder& pile, double kink /* [cell²] */) {
    return kink * 2 * std::numbers::pi * (pile.foot() + pile.top()) / pile.volume();
}

/// Returns the share that is misplaced by steepness. A slope at rest may be steeper than the talus by the resting
/// excess. Turning a cone's slope about its mean height by a share of it misplaces 0.59 of that share. A frustum's
/// slope misplaces less.
double misplacedBySteepness() { return 0.59 * samples::restingExcess(sand::kUnitsPerCell) / sand::kUnitsPerCell; }

struct Shape {
    double radius;  // [side of the field]
    double ratio;   // height / radius
    double kink;    // [cell²] allowed
};

// The flat cylinder becomes a ramp of 1.6 cells at 64, whose kinks share most of their error. A tall cylinder becomes a
// cone from a ratio of sqrt(3) on.
constexpr std::array kShapes{Shape{0.25, 0.1, 0.1}, Shape{0.25, 1.5, 0.25}, Shape{0.15, 3, 0.25}};

TEST(PileOracle, FlatAndTallCylindersBecomeFrustumAndCone) {
    for (const Law& law : samples::laws()) {
        for (const Shape& shape : kShapes) {
            double coarser = 1;
            for (const int n : {64, 128, 256}) {
                if (n > (law.inertial() ? 256 : 128)) {
                    continue;  // takes seconds without inertia
                }
                const Cylinder cylinder(shape.radius * n, shape.ratio * shape.radius * n);
                const double misplaced = settledCylinder(n, cylinder, law).distance.misplaced;
                EXPECT_LE(misplaced, misplacedAtKinks(cylinder, shape.kink) + misplacedBySteepness())
                    << nameOf(law) << ", height / radius " << shape.ratio << ", " << n << " cells";
                EXPECT_LE(misplaced, 0.7 * coarser) << "does not converge: height / radius " << shape.ratio;
                coarser = misplaced;
            }
        }
    }
}

TEST(PileOracle, APileIsRound) {
    for (const Law& law : samples::laws()) {
        for (const auto& [n, allowed] : {std::pair{64, 0.0035}, {128, 0.0015}}) {
            const Cylinder cylinder(0.25 * n, 0.15 * n);
            for (const double height : {0.25, 0.5}) {  // clear of the kinks at top and foot
                double nearest = n;
                double farthest = 0;
                double sum = 0;
                for (int degrees = 0; degrees < 360; ++degrees) {
                    const double radius =
                        oracles::radiusAt(lowPile(n, law).field, n / 2.0, n / 2.0, degrees, height * cylinder.apex());
                    nearest = std::min(nearest, radius);
                    farthest = std::max(farthest, radius);
                    sum += radius;
                }
                EXPECT_LE((farthest - nearest) / (sum / 360), allowed)
                    << nameOf(law) << ", " << n << " cells, at " << height << " of the height";
            }
        }
    }
}

// The tests above can fail: a rule that looks only along the axes rests in another pile at every resolution. That pile
// is narrower on the diagonals.
TEST(PileOracle, FourNeighboursMakeAWrongPile) {
    for (const int n : {64, 128}) {
        const Cylinder cylinder(0.25 * n, 0.15 * n);
        HeightField field = cylinderOn(n, cylinder);
        reference::relax(field, sand::kUnitsPerCell, reference::FourNeighbours());
        EXPECT_NEAR(distanceToRest(field, cylinder).misplaced, 0.045, 0.003) << n;
        const auto radius = [&](double degrees) {
            return oracles::radiusAt(field, n / 2.0, n / 2.0, degrees, 0.5 * cylinder.apex());
        };
        EXPECT_GE(radius(0), 1.03 * radius(45)) << n;
    }
}

/// Returns the misplaced share of the same round pile on cells that are `aspect` times as long from south to north, in
/// a square domain.
double misplacedOnOblong(int columns, int rows, double aspect, const Law& law) {
    const double side = std::min<double>(columns, rows * aspect);
    const Cylinder cylinder(0.25 * side, 0.15 * side);
    const auto stretched = [&](auto radial) {
        return [=](double x, double y) { return radial(std::hypot(x - columns / 2.0, (y - rows / 2.0) * aspect)); };
    };
    HeightField field = oracles::fieldOf(columns, rows, stretched([&](double r) { return cylinder.start(r); }));
    sand::Rules rules = samples::rulesFor(field, law);
    rules.aspect = static_cast<std::int32_t>(aspect * sand::kUnitsPerCell);
    samples::relax(field, rules);
    const auto expected = oracles::sampled(columns, rows, stretched([&](double r) { return cylinder.rest(r); }));
    return oracles::distance(field, expected).misplaced;
}

// A prototype gave 0.046 % and 0.137 % for 2:1 and 4:1 at N = 256. Measured here with a radius of 64 cells: 0.050 % and
// 0.140 % with inertia, 0.050 % and 0.148 % without. Shifting the pile by half a cell changes that by up to 15 %. The
// tolerance is the measurement plus that change.
TEST(PileOracle, CellsNeedNotBeSquare) {
    for (const Law& law : samples::laws()) {
        EXPECT_LE(misplacedOnOblong(256, 128, 2, law), 0.00058) << nameOf(law);
        EXPECT_LE(misplacedOnOblong(256, 64, 4, law), 0.0016) << nameOf(law);
        EXPECT_LE(misplacedOnOblong(128, 256, 0.5, law), 0.00058) << nameOf(law);
        EXPECT_LE(misplacedOnOblong(64, 256, 0.25, law), 0.0016) << nameOf(law);
        EXPECT_LE(misplacedOnOblong(128, 64, 2, law), 0.002) << nameOf(law) << ", half as fine";
        EXPECT_LE(misplacedOnOblong(128, 32, 4, law), 0.005) << nameOf(law) << ", half as fine";
    }
}

}  // namespace
