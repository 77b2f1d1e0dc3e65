// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sand/force/contact_force.hpp"

namespace {

using namespace sand::force;

TEST(ContactForce, GuardShortensWithoutTurningAndStopsWhatIsNoForce) {
    const Vec3 clamped = guarded({30, 0, 40}, 0);
    EXPECT_NEAR(norm(clamped), kDeviceLimit, 1e-12);
    EXPECT_NEAR(clamped.x / clamped.z, 0.75, 1e-12);
    EXPECT_EQ(guarded({1, 2, 2}, 0).y, 2);
    EXPECT_EQ(norm(guarded({std::nan(""), 0, 1}, 0)), 0);
    EXPECT_EQ(norm(guarded({0, std::numeric_limits<double>::infinity(), 1}, 0)), 0);
    EXPECT_EQ(norm(guarded({0, 0, 1}, 0.051)), 0) << "a stale surface";
    EXPECT_EQ(norm(guarded({0, 0, 1}, std::nan(""))), 0);
}

}  // namespace
