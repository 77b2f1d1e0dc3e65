// SPDX-License-Identifier: Apache-2.0
// Random force laws: what the check of finite laws accepts and refuses, beside the law itself on real sand.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sand/force/finite_law.hpp"
#include "sand/force/law.hpp"
#include "sand/force/tool_contour.hpp"
#include "tests/support/seed.hpp"

namespace {

using sand::ForceConstants;
using sand::ForceLaw;
using namespace sand::force;

/// Random laws, tools, fields and sand.
class RandomLaw : public testing::Test {
protected:
    double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
    double logarithmic(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
    bool oneIn(int count) { return std::uniform_int_distribution<int>(1, count)(random_) == 1; }

    /// Returns constants within the bounds of a scene file. Some are at a bound.
    ForceConstants anyConstants(const LawRegion& region) {
        ForceConstants constants;
        constants.law = oneIn(2) ? ForceLaw::repulse : ForceLaw::controlPoints;
        constants.literal = oneIn(2);
        constants.frictionDirection =
            static_cast<sand::FrictionDirection>(std::uniform_int_distribution<int>(0, 2)(random_));
        for (const sand::ForceKey& key : sand::forceKeys()) {
            const double low = std::max(key.lowest, 1e-300);
            constants.*key.constant = oneIn(6) ? key.lowest : oneIn(6) ? key.highest : logarithmic(low, key.highest);
        }
        if (oneIn(2)) {  // otherwise most of these constants are refused
            constants.depthExponent = uniform(0, 2) * 340 / region.deepest;
            constants.unitLength = region.deepest * logarithmic(1e-3, 1e3);
        }
        constants.depthExponent = std::min(constants.depthExponent, 1e6);
        return constants;
    }
    Contour anyTool(double radius) {
        const auto units = static_cast<std::int32_t>(1000);
        const sand::Tool tool{
            static_cast<sand::ToolKind>(std::uniform_int_distribution<int>(0, sand::kToolKinds - 1)(random_)), units,
            static_cast<std::int32_t>(uniform(0.05, 1) * units), *sand::headingOf(uniform(-180, 180))};
        return contourOf(tool, radius / units * sand::kProbePerCell);
    }
    /// Returns rough sand around a tool: from level sand to the steepest that heights can make.
    SurfacePatch anySand(double reach) {
        sand::HeightField field(kCells, kCells, reach / kPerReach);
        const double height = oneIn(4) ? 0 : oneIn(4) ? sand::kMaxHeight : logarithmic(1, sand::kMaxHeight);
        const double slope = oneIn(2) ? uniform(-1, 1) * sand::kMaxHeight / kCells : 0;
        for (int row = 0; row < kCells; ++row) {
            for (int column = 0; column < kCells; ++column) {
                const double at = slope != 0 ? slope * (column + row - kCells) : uniform(-height, height);
                field.setHeight(column, row, static_cast<std::int32_t>(at));
            }
        }
        constexpr int kMiddle = kCells / 2 * sand::kProbePerCell + sand::kProbePerCell / 2;
        return {field, {kMiddle, kMiddle, 0}, reach};
    }
    /// Returns the place in the middle of `sand` at which the law reads `depth` at most.
    static Vec3 placeAt(double depth, ForceConstants constants, const SurfacePatch& sand, const Contour& tool) {
        const double middle = kCells / 2.0 * tool.reach / kPerReach;
        constants.unitLength = 1;
        const Gauges gauges = measure(constants, sand, tool, {middle, middle, 0});
        double deepest = gauges.dials[0].value;
        for (std::size_t i = 0; constants.law == ForceLaw::controlPoints && i < gauges.count; ++i) {
            deepest = std::max(deepest, gauges.dials[i].value);
        }
        return {middle, middle, deepest - depth};
    }
    /// Returns whether the law is finite there for a device, when the tool moves as fast as it can.
    bool finiteAt(const ForceConstants& constants, const SurfacePatch& sand, const Contour& tool, Vec3 place,
                  const LawRegion& region) {
        const Response felt = respond(constants, sand, tool, place);
        const Vec3 way{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
        const Vec3 lawful = lawfulForce(felt, (region.fastest / norm(way)) * way);
        return std::isfinite(norm(lawful)) && std::isfinite(felt.stiffness * region.scale) &&
               std::isfinite(norm(felt.normal));
    }

    static constexpr int kCells = 33, kPerReach = 4;
    const unsigned seed_ = test::randomSeed();
    std::mt19937 random_{seed_};
};

TEST_F(RandomLaw, ThatIsAcceptedIsFiniteAtAThousandPlaces) {
    SCOPED_TRACE(test::again(seed_));
    int accepted = 0;
    for (int law = 0; law < 150; ++law) {
        const LawRegion region =
            LawRegion::of(std::uniform_int_distribution<int>(1, 16384)(random_), logarithmic(1e-4, 1e3));
        const ForceConstants constants = anyConstants(region);
        if (faultOf(constants, region)) {
            continue;
        }
        ++accepted;
        for (int patch = 0; patch < 20; ++patch) {
            const double radius = oneIn(3)   ? region.smallestRadius
                                  : oneIn(3) ? region.largestRadius
                                             : logarithmic(region.smallestRadius, region.largestRadius);
            const Contour tool = anyTool(radius);
            const SurfacePatch sand = anySand(tool.reach);
            for (int place = 0; place < 50; ++place) {
                const double depth = (1 - 1e-9) * (oneIn(2) ? region.deepest * uniform(0, 1)
                                                            : std::min(region.deepest, radius * uniform(0, 2)));
                ASSERT_TRUE(finiteAt(constants, sand, tool, placeAt(depth, constants, sand, tool), region))
                    << "law " << law << ", depth " << depth << " of " << region.deepest << ", radius " << radius
                    << ", k_s " << constants.stiffness << ", k_c " << constants.depthExponent << ", F_M "
                    << constants.maxForce << ", L " << constants.unitLength;
            }
        }
    }
    EXPECT_GT(accepted, 30) << "the test must try some laws";
}

// A refused law need not overflow on level sand, because the steepest sand decides. A little beyond the bound it does.
TEST_F(RandomLaw, ThatIsRefusedIsNotFiniteALittleBeyondTheNamedBound) {
    SCOPED_TRACE(test::again(seed_));
    int refused = 0;
    for (int law = 0; law < 400; ++law) {
        const LawRegion region =
            LawRegion::of(std::uniform_int_distribution<int>(1, 16384)(random_), logarithmic(1e-2, 1e3));
        ForceConstants constants = anyConstants(region);
        const auto fault = faultOf(constants, region);
        if (!fault) {
            continue;
        }
        ++refused;
        ASSERT_TRUE(fault->allowed) << "one constant alone is at fault";
        // k_c d is 270 or more at the bound: kRoot = e^355 over constants and speeds of at most e^80. A fifth more is
        // e^54 times the force. The steepest sand is 2 · 8192 · sqrt(2) = e^10 times as stiff as level sand.
        constants.*fault->key->constant = fault->atMost ? *fault->allowed * 1.2 : *fault->allowed / 1e3;
        const Contour tool = Contour::sphere(fault->radius);
        const sand::HeightField level(kCells, kCells, tool.reach / kPerReach);
        constexpr int kMiddle = kCells / 2 * sand::kProbePerCell;
        const SurfacePatch sand(level, {kMiddle, kMiddle, 0}, tool.reach);
        EXPECT_FALSE(finiteAt(constants, sand, tool, placeAt(fault->depth, constants, sand, tool), region))
            << "law " << law << ", " << fault->key->name << " " << fault->value << ", allowed " << *fault->allowed
            << ", depth " << fault->depth;
    }
    EXPECT_GT(refused, 10) << "the test must try some laws";
}

}  // namespace
