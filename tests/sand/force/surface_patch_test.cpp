// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/sand/force/force_samples.hpp"

namespace {

using namespace samples;

TEST(SurfacePatch, IsTheFieldAroundTheToolEvenAtACorner) {
    EXPECT_NEAR(slopePatch(0.25).height(kMiddle + 0.01, kMiddle), 0.0025, 1e-7);
    sand::HeightField tiny(1, 1, 1.0);
    tiny.setHeight(0, 0, sand::kUnitsPerCell);
    EXPECT_NEAR(SurfacePatch(tiny, {-5000, 9000, 0}, 0.5).height(0.1, 0.9), 1.0, 1e-6);
    sand::HeightField wide(4096, 4096, 1.0);
    EXPECT_EQ(SurfacePatch(wide, {0, 0, 0}, 2048).height(10, 10), 0) << "the largest tool fits a patch";
}

TEST(SurfacePatch, KnowsItsGradient) {
    const auto at = slopePatch(0.25).tangent(kMiddle + 0.0031, kMiddle - 0.0017);
    EXPECT_NEAR(at.slope.x, 0.25, 1e-4);
    EXPECT_NEAR(at.slope.y, 0, 1e-4);
    EXPECT_EQ(slopePatch(0.25).tangent(-1, kMiddle).slope.x, 0) << "nothing rises beyond its edge";
}

}  // namespace
