// SPDX-License-Identifier: Apache-2.0
#include "render_node/tool/force.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "sand/model/ground.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/pictures/sample_scene.hpp"
#include "tests/support/sand/sand_of.hpp"

namespace {

using render_node::ForceArrow;
using render_node::ToolForce;

constexpr double kRadius = 0.04;  // [scene unit], 5 cells
// Places are floats near 1, with an error of 6e-8 each. An arrow has 0.06 scene units per newton.
constexpr double kNewtonsOfFloats = 4e-6;

/// Field of 250 x 250 cells under a tool of radius 5 cells. It is bare rock, so that no tool changes it and depths are
/// exact.
scene::Scene rockScene() {
    scene::Scene scene = sample::flatScene(250, 250, kRadius);
    scene.rules.tuning.tool.radius = 5 * sand::kProbePerCell;
    auto rock = std::make_shared<sand::Ground>(250, 250);
    for (int row = 0; row < 250; ++row) {
        for (int column = 0; column < 250; ++column) {
            rock->setBedrock(column, row, 0);
        }
    }
    scene.ground = std::move(rock);
    return scene;
}

class Arrow : public testing::Test {
protected:
    /// Applies the next step, with the tool's centre at this place [cell], touching.
    void press(const glm::dvec3& place, bool engaged = true) { press(replica_, place, engaged); }
    static void press(sand::Replica& replica, const glm::dvec3& place, bool engaged = true) {
        const glm::ivec3 at(place * double{sand::kProbePerCell});
        replica.apply({0, replica.stepNumber() + 1, engaged, {{at.x, at.y, at.z}}});
    }
    static double newtons(const ForceArrow& arrow) {
        return double{glm::length(arrow.to - arrow.from)} / (render_node::kArrowPerNewton * kRadius);
    }
    static void expectNear(const glm::vec3& found, const glm::dvec3& wanted, double within) {
        EXPECT_NEAR(double{found.x}, wanted.x, within);
        EXPECT_NEAR(double{found.y}, wanted.y, within);
        EXPECT_NEAR(double{found.z}, wanted.z, within);
    }

    scene::Scene scene_ = rockScene();
    sand::Replica replica_{scene_};
};

// On level ground, a tool whose centre is at a height of 4 and 2 cells is 1 and 3 cells deep: 0.008 and 0.024. With k_s
// = 100 the push is 100 (e^0.004 - 1) and 100 (e^0.012 - 1) N.
TEST_F(Arrow, IsAsLongAsTheForceIsLarge) {
    scene_.force = {100, 0.5, 0};
    ToolForce force(scene_.force);
    press({125, 125, 4});
    const auto light = force.arrow(replica_);
    ASSERT_TRUE(light);
    EXPECT_NEAR(newtons(*light), 0.4008011, kNewtonsOfFloats);
    EXPECT_FALSE(light->longest);
    expectNear(light->from, {1, 1, 0.032 + kRadius}, 1e-7);  // on the tool's surface
    expectNear(light->to, {1, 1, 0.032 + kRadius + 1.5 * kRadius * 0.4008011}, 1e-7);
    press({125, 125, 2});
    EXPECT_NEAR(newtons(*force.arrow(replica_)), 1.2072289, kNewtonsOfFloats);
}

// The ground is 0.02 above the lowest point. The push is 10 N times 0.02 divided by the unit length, which is 1, and
// not 500.
TEST_F(Arrow, FollowsTheScenesLaw) {
    scene_.force.law = sand::ForceLaw::controlPoints;
    ToolForce force(scene_.force);
    press({125, 125, 2.5});
    const auto arrow = force.arrow(replica_);
    ASSERT_TRUE(arrow);
    EXPECT_NEAR(newtons(*arrow), 0.2, kNewtonsOfFloats);
}

TEST_F(Arrow, EndsAtTheGreatestForceThatADeviceGives) {
    scene_.force = {10000, 0.5, 0};
    ToolForce force(scene_.force);
    press({125, 125, 0});
    const auto arrow = force.arrow(replica_);
    ASSERT_TRUE(arrow);
    EXPECT_TRUE(arrow->longest);
    EXPECT_NEAR(newtons(*arrow), 3.3, kNewtonsOfFloats) << "docs/look.md";
}

// At a depth of 0.02 the push is 50 (e^0.01 - 1) = 0.5025084 N. The hand moves 1.25 cells, 0.01, in a step of 1/60 s.
// The friction is 50 · 0.01 of the push, so that the arrow leans back by one in two.
TEST_F(Arrow, LeansAgainstTheHandsMovement) {
    scene_.force = {50, 0.5, 50};
    ToolForce force(scene_.force);
    for (int i = 0; i < 3; ++i) {
        press({125 + 1.25 * i, 125, 2.5});
        (void)force.arrow(replica_);
    }
    press({125 + 1.25 * 3, 125, 2.5});
    const auto moving = force.arrow(replica_);
    ASSERT_TRUE(moving);
    const glm::dvec3 along(moving->to - moving->from);
    constexpr double kPerNewton = 1.5 * kRadius;  // [scene unit]
    expectNear(along, {-0.2512542 * kPerNewton, 0, 0.5025084 * kPerNewton}, 2.5e-7);
    EXPECT_EQ(force.arrow(replica_), moving) << "a frame without a step shows what the frame before did";
}

TEST_F(Arrow, IsNotThereWhileTheToolHoversOrTouchesNothing) {
    ToolForce force(scene_.force);
    EXPECT_FALSE(force.arrow(replica_)) << "before the first step";
    press({125, 125, 2.5}, false);
    EXPECT_FALSE(force.arrow(replica_));
    press({125, 125, 15});
    EXPECT_FALSE(force.arrow(replica_));
    press({375, 125, 0});
    EXPECT_FALSE(force.arrow(replica_)) << "beside the field";
}

TEST_F(Arrow, LeavesTheSandAlone) {
    const scene::Scene sandy = sample::flatScene(250, 250, kRadius);
    ToolForce force(sandy.force);
    sand::Replica felt(sandy), untouched(sandy);
    const std::uint64_t level = felt.stateHash();
    for (int i = 0; i < 20; ++i) {
        for (sand::Replica* replica : {&felt, &untouched}) {
            press(*replica, {125 + 1.25 * i, 125, 2.5});
        }
        EXPECT_TRUE(force.arrow(felt));
        EXPECT_EQ(felt.stateHash(), untouched.stateHash());
        EXPECT_NE(samples::fieldOf(felt).height(125, 125), 0) << "the tool digs";
    }
    EXPECT_NE(felt.stateHash(), level);
}

TEST_F(Arrow, LiesWithinItsBox) {
    int vertices = 0;
    for (const glm::vec3 to :
         {glm::vec3(0.1F, 0, 0.001F), {0, 0, 0.3F}, {-0.01F, 0.02F, 0.01F}, {0.05F, -0.2F, -0.1F}}) {
        const ForceArrow arrow{{1, 1, 0}, glm::vec3(1, 1, 0) + to, false};
        constexpr auto kBall = static_cast<float>(kRadius);
        const shapes::Box box = boxOf(arrow, kBall);
        for (const shapes::SolidVertex& vertex : makeArrow(arrow, kBall)) {
            EXPECT_TRUE(glm::all(glm::lessThanEqual(box.low, glm::dvec3(vertex.position))));
            EXPECT_TRUE(glm::all(glm::greaterThanEqual(box.high, glm::dvec3(vertex.position))));
            EXPECT_NEAR(glm::length(vertex.normal), 1, 1e-5);
            ++vertices;
        }
    }
    EXPECT_GT(vertices, 4 * 3 * 8) << "a shaft and a head of several sides";
}

}  // namespace
