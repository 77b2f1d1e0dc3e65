// SPDX-License-Identifier: Apache-2.0
// [force] of a scene file.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "scene/load/scene_file.hpp"
#include "tests/scene/scene_fixture.hpp"

namespace {

class ForceTable : public SceneFile {
protected:
    std::string said(const std::string& keys) { return complaint(kFlat + "[force]\n" + keys + "\n"); }
};

TEST_F(ForceTable, DefaultsAreThePapers) {
    const sand::ForceConstants force = scene::loadScene(write("s.toml", kFlat)).force;
    EXPECT_EQ(force.law, sand::ForceLaw::repulse);
    EXPECT_EQ(force.between, sand::Between::local);
    EXPECT_FALSE(force.literal);
    EXPECT_EQ(force.stiffness, 1000);
    EXPECT_EQ(force.depthExponent, 0.5);
    EXPECT_EQ(force.friction, 10);
    EXPECT_EQ(force.maxForce, 10);
    EXPECT_EQ(force.unitLength, 2) << "the field's side, with or without a table";
    EXPECT_EQ(scene::loadScene(write("s.toml", kFlat + "[force]\nfriction = 0\n")).force.unitLength, 2);
}

TEST_F(ForceTable, TravelsWithTheSceneAndIsNoPartOfItsRules) {
    const scene::Scene plain = scene::loadScene(write("s.toml", kFlat));
    const scene::Scene scene = scene::loadScene(write(
        "s.toml", kFlat + "[force]\nlaw = \"control_points\"\nliteral = true\nbetween = \"interpolate\"\n"
                          "stiffness = 1\ndepth_exponent = 2\nfriction = 3\nfriction_area = 4\n"
                          "friction_direction = \"vertical\"\nmax_force = 5\ntolerance = 0.25\nunit_length = 7\n"
                          "friction_coefficient = 0.5\nfriction_speed = 8\nvalidity = 1.5\nrecovery_time = 0.5\n"));
    EXPECT_EQ(scene.force.frictionArea, 4);
    EXPECT_EQ(scene.force.frictionDirection, sand::FrictionDirection::vertical);
    EXPECT_EQ(scene.force.unitLength, 7);
    EXPECT_EQ(scene.force.recoveryTime, 0.5);
    EXPECT_EQ(scene::Scene::decode(scene.encode()).force, scene.force);
    EXPECT_EQ(scene.rules.digest(), plain.rules.digest());
}

TEST_F(ForceTable, RefusesInOneLineWhatIsNoConstant) {
    EXPECT_EQ(said("stiffness = -1"), "s.toml:5: stiffness must be within [0, 1000000000], got -1");
    EXPECT_EQ(said("stiffness = nan"), "s.toml:5: stiffness must be a finite number");
    EXPECT_EQ(said("max_force = inf"), "s.toml:5: max_force must be a finite number");
    EXPECT_EQ(said("unit_length = 0"), "s.toml:5: unit_length must be positive, got 0");
    EXPECT_EQ(said("tolerance = 2"), "s.toml:5: tolerance must be within [0, 1], got 2");
    EXPECT_EQ(said("law = \"spring\""), "s.toml:5: law must be one of repulse, control_points, got 'spring'");
    EXPECT_EQ(said("friction_direction = \"full\""),
              "s.toml:5: friction_direction other than tangential is for comparison: set literal = true beside it");
    EXPECT_EQ(said("stifness = 3").find("s.toml:5: unknown key 'stifness'; known here: between, "), 0U);
    for (const std::string key :
         {"depth_exponent", "friction", "friction_area", "max_force", "tolerance", "unit_length",
          "friction_coefficient", "friction_speed", "validity", "recovery_time"}) {
        for (const std::string value : {"-1", "nan", "-inf"}) {
            EXPECT_EQ(said(fmt::format("{} = {}", key, value)).find("s.toml:5: " + key + " must be"), 0U)
                << key << " " << value;
        }
    }
}

TEST_F(ForceTable, RefusesBytesThatNoSceneFileGives) {
    const scene::Scene scene = scene::loadScene(write("s.toml", kFlat));
    base::Bytes bytes = scene.encode();
    bytes[bytes.size() - 4] = 9;  // the law
    EXPECT_THROW((void)scene::Scene::decode(bytes), base::FormatError);
    scene::Scene negative = scene;
    negative.force.maxForce = -1;
    EXPECT_THROW((void)scene::Scene::decode(negative.encode()), base::FormatError);
}

}  // namespace
