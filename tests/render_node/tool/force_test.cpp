// SPDX-License-Identifier: Apache-2.0
#include "render_node/tool/force.hpp"

#include <gtest/gtest.h>

#include "scene/scene.hpp"
#include "tests/support/sample_scene.hpp"

namespace {

using render_node::ForceArrow;
using render_node::ToolForce;

constexpr float kRadius = 0.04F;

class Arrow : public testing::Test {
protected:
    /// The next step, there and touching.
    void press(const glm::dvec3& place, bool engaged = true) {
        terrain_.apply({0, terrain_.stepNumber() + 1, engaged, {sample::probeAt(scene_, place)}});
    }
    double newtons(const ForceArrow& arrow) const {
        return double{glm::length(arrow.to - arrow.from)} / (render_node::kArrowPerNewton * scene_.toolRadius());
    }

    scene::Scene scene_ = sample::flatScene(256, 256, double{kRadius});
    sand::Replica terrain_{scene_};
};

TEST_F(Arrow, IsAsLongAsTheForceIsLarge) {
    scene_.force = {100, 0.5, 0};
    ToolForce force(scene_.force);
    press({1, 1, 0.8F * kRadius});
    const auto light = force.arrow(terrain_);
    const sand::force::SurfacePatch patch(terrain_.field(), terrain_.probe(), scene_.toolRadius());
    const double unit = scene_.terrain.cellSize() / sand::kProbePerCell;
    const auto probe = terrain_.probe();
    const auto contact = sand::force::measureContact(patch, {unit * probe.x, unit * probe.y, unit * probe.z},
                                                     sand::force::Contour::sphere(scene_.toolRadius()));
    ASSERT_TRUE(light);
    EXPECT_NEAR(newtons(*light), 100 * std::expm1(0.5 * contact.depth.value), 1e-4);
    EXPECT_GT(newtons(*light), 0.1);
    EXPECT_FALSE(light->longest);
    EXPECT_GT(light->to.z, light->from.z);
    EXPECT_NEAR(glm::length(light->from - glm::vec3(1, 1, 0.8F * kRadius)), kRadius, 1e-3) << "from the tool's surface";
    press({1, 1, 0.4F * kRadius});
    EXPECT_GT(newtons(*force.arrow(terrain_)), 1.2 * newtons(*light));
}

TEST_F(Arrow, FollowsTheScenesLaw) {
    // Level sand and a light touch: dh is the depth over the unit length, all around.
    scene_.force.law = sand::ForceLaw::controlPoints;
    ToolForce force(scene_.force);
    press({1, 1, 0.5F * kRadius});
    const auto arrow = force.arrow(terrain_);
    ASSERT_TRUE(arrow);
    EXPECT_GT(newtons(*arrow), 10 * 0.4 * double{kRadius});
    EXPECT_LT(newtons(*arrow), 10 * double{kRadius}) << "ten newtons a unit, not five hundred";
}

TEST_F(Arrow, EndsAtTheGreatestForceThatADeviceGives) {
    scene_.force = {10000, 0.5, 0};
    ToolForce force(scene_.force);
    press({1, 1, 0});
    const auto arrow = force.arrow(terrain_);
    ASSERT_TRUE(arrow);
    EXPECT_TRUE(arrow->longest);
    EXPECT_NEAR(newtons(*arrow), render_node::kMostNewtons, 1e-4);
}

TEST_F(Arrow, LeansAgainstTheHandsMovement) {
    scene_.force = {50, 0.5, 50};
    ToolForce force(scene_.force);
    for (int i = 0; i < 3; ++i) {
        press({1 + 0.01 * i, 1, 0.5F * kRadius});
        (void)force.arrow(terrain_);
    }
    press({1.03, 1, 0.5F * kRadius});
    const auto moving = force.arrow(terrain_);
    ASSERT_TRUE(moving);
    EXPECT_LT(moving->to.x, moving->from.x - 0.1F * (moving->to.z - moving->from.z));
    EXPECT_EQ(force.arrow(terrain_), moving) << "a frame without a step shows what the frame before did";
}

TEST_F(Arrow, IsNotThereWhileTheToolHoversOrTouchesNothing) {
    ToolForce force(scene_.force);
    EXPECT_FALSE(force.arrow(terrain_)) << "before the first step";
    press({1, 1, 0.5F * kRadius}, false);
    EXPECT_FALSE(force.arrow(terrain_));
    press({1, 1, 3 * kRadius});
    EXPECT_FALSE(force.arrow(terrain_));
    press({3, 1, 0});
    EXPECT_FALSE(force.arrow(terrain_)) << "beside the field";
}

TEST_F(Arrow, LeavesTheSandAlone) {
    ToolForce force(scene_.force);
    sand::Replica untouched(scene_);
    for (int i = 0; i < 20; ++i) {
        press({1 + 0.01 * i, 1, 0.5F * kRadius});
        untouched.apply({0, untouched.stepNumber() + 1, true, {terrain_.probe()}});
        EXPECT_TRUE(force.arrow(terrain_));
        EXPECT_EQ(terrain_.stateHash(), untouched.stateHash());
    }
}

TEST_F(Arrow, LiesWithinItsBox) {
    int vertices = 0;
    for (const glm::vec3 to :
         {glm::vec3(0.1F, 0, 0.001F), {0, 0, 0.3F}, {-0.01F, 0.02F, 0.01F}, {0.05F, -0.2F, -0.1F}}) {
        const ForceArrow arrow{{1, 1, 0}, glm::vec3(1, 1, 0) + to, false};
        const render_node::Box box = boxOf(arrow, kRadius);
        for (const render_node::SolidVertex& vertex : makeArrow(arrow, kRadius)) {
            EXPECT_TRUE(glm::all(glm::lessThanEqual(box.low, glm::dvec3(vertex.position))));
            EXPECT_TRUE(glm::all(glm::greaterThanEqual(box.high, glm::dvec3(vertex.position))));
            EXPECT_NEAR(glm::length(vertex.normal), 1, 1e-5);
            ++vertices;
        }
    }
    EXPECT_GT(vertices, 4 * 3 * 8) << "a shaft and a head of several sides";
}

}  // namespace
