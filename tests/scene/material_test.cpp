// SPDX-License-Identifier: Apache-2.0
#include "scene/model/material.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <set>
#include <string_view>

#include "base/input_error.hpp"
#include "sand/replica.hpp"
#include "scene/load/scene_file.hpp"
#include "tests/support/files/scene_fixture.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/sand/sand_of.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

using sand::Edit;

// A scene file and an operator's command use the same conversion from numbers to rules.
TEST_F(SceneFile, AnOperatorsNumbersBecomeTheRulesOfAFileThatSaysThem) {
    const scene::Scene plain = scene::loadScene(write("plain.toml", kFlat));
    const auto grid = plain.grid();
    const auto same = [&](const scene::Material& material, const std::string& file) {
        EXPECT_EQ(scene::tuningOf(material, grid), scene::loadScene(write("s.toml", kFlat + file)).rules.tuning)
            << file;
    };
    same(plain.material, "");
    same(scene::withNumber(plain.material, "talus", 20, grid), "talus_deg = 20\n");
    same(scene::withNumber(plain.material, "talus_deg", 50, grid), "talus_deg = 50\n");
    same(scene::withTool(plain.material, {.radius = 0.05}, grid), "[tool]\nradius = 0.05\n");
    const scene::Material oval =
        scene::withTool(plain.material, {.kind = sand::ToolKind::ellipse, .width = 0.3, .heading = -45}, grid);
    same(oval, "[tool]\nshape = \"ellipse\"\nwidth = 0.3\nheading_deg = -45\n");
    same(scene::withTool(oval, {.kind = sand::ToolKind::footprint, .leftFoot = true}, grid),
         "[tool]\nshape = \"footprint\"\nfoot = \"left\"\nheading_deg = -45\n");
    scene::Material wet = scene::withNumber(plain.material, "humidity", 0.5, grid);
    wet = scene::withNumber(wet, "wet-talus", 60, grid);
    wet = scene::withNumber(wet, "cohesion", 0.03, grid);
    wet = scene::withNumber(wet, "settling-time", 0.01, grid);
    same(wet, "humidity = 0.5\nwet_talus_deg = 60\ncohesion_length = 0.03\nsettling_time = 0.01\n");
}

TEST_F(SceneFile, AnOperatorsNumbersAreRefusedWhereAFileWouldBe) {
    const scene::Scene scene = scene::loadScene(write("s.toml", kFlat + "wet_talus_deg = 40\n"));
    const auto number = [&](std::string_view word, double value) {
        return test::refusalOf([&] { (void)scene::withNumber(scene.material, word, value, scene.grid()); });
    };
    const auto tool = [&](double radius) {
        return test::refusalOf([&] { (void)scene::withTool(scene.material, {.radius = radius}, scene.grid()); });
    };
    EXPECT_EQ(number("talus", 90), "talus must be within [0, 90), got 90");
    EXPECT_EQ(number("talus", 41), "wet_talus_deg must be at least talus_deg = 41, got 40");
    EXPECT_EQ(number("humidity", -0.5), "humidity must be within [0, 1], got -0.5");
    EXPECT_EQ(number("colour", 1),
              "a material has no 'colour'; there are talus, wet-talus, humidity, cohesion, band, settling-time");
    EXPECT_EQ(tool(10), "a tool of radius 10 is 2560 cells of 0.00390625; 2048 is the most");
    EXPECT_EQ(tool(0).find("a tool's radius must be at least 1.53e-05, got 0"), 0U) << tool(0);
    EXPECT_NE(tool(-1), "nothing");
    const auto changed = [&](const scene::ToolChange& change) {
        return test::refusalOf([&] { (void)scene::withTool(scene.material, change, scene.grid()); });
    };
    EXPECT_EQ(changed({.kind = sand::ToolKind::footprint, .radius = 1.5}),
              "a footprint of radius 1.5 is 3 long, but the field only 2");
    EXPECT_EQ(changed({.width = 0.5}), "a sphere is as wide as it is long; leave width out");
    EXPECT_EQ(changed({.kind = sand::ToolKind::ellipse, .width = 0.01}),
              "a tool's width over its length must be within [0.05, 1], got 0.01");
    EXPECT_EQ(changed({.heading = std::nan("")}), "a tool's heading must be a number of degrees");
}

TEST(Material, EachNumberIsSetAndReadByItsKeyAndIsInItsBytes) {
    for (const scene::MaterialKey& key : scene::materialKeys()) {
        const double other = std::midpoint(key.get({}), key.highest);
        scene::Material material;
        key.set(material, other);
        EXPECT_EQ(key.get(material), other) << key.key;
        EXPECT_EQ(key.get(base::decoded<scene::Material>(base::encoded(material))), other) << key.key;
    }
}

TEST(Material, HasAKeyForEachMemberThatIsNoPartOfTheTool) {
    std::set<std::string_view> members;
    const auto collect = [&members](std::string_view name, const auto& /*member*/) { members.insert(name); };
    const scene::Material material;
    scene::Material::fields(material, collect);
    std::set<std::string_view> known{"kind", "radius", "width", "heading_deg", "left_foot"};
    for (const scene::MaterialKey& key : scene::materialKeys()) {
        known.insert(key.key);
    }
    EXPECT_EQ(members, known);
}

/// A pile at rest whose talus an operator halves.
TEST(Tuning, AFlatterTalusWakesSandAtRest) {
    scene::Scene scene = samples::flatScene(64, 64);
    scene.terrain = samples::cylinder(64, 16, 20);
    sand::Replica replica(scene);
    replica.apply({1, 1, false, {}, Edit::settle});
    while (!replica.settled()) {
        replica.apply({1, replica.stepNumber() + 1, false, {}, Edit::none});
    }
    const sand::HeightField rest = samples::fieldOf(replica);
    const std::uint64_t hash = replica.stateHash();
    sand::Tuning tuning = scene.rules.tuning;
    replica.apply({1, replica.stepNumber() + 1, false, {}, Edit::tuned(tuning)});
    EXPECT_TRUE(sameHeights(samples::fieldOf(replica), rest)) << "the same material moves nothing";
    tuning.threshold /= 2;
    tuning.startThreshold /= 2;
    replica.apply({1, replica.stepNumber() + 1, false, {}, Edit::tuned(tuning)});
    EXPECT_FALSE(replica.settled());
    EXPECT_FALSE(sameHeights(samples::fieldOf(replica), rest));
    EXPECT_EQ(samples::fieldOf(replica).volume(), rest.volume());
    EXPECT_NE(replica.stateHash(), hash);
}

// Two replicas with equal sand and different tools differ one step later. The hash must show that at once.
TEST(Tuning, IsPartOfTheHashAndOfTheState) {
    const scene::Scene scene = samples::flatScene(64, 64);
    sand::Tuning tuning = scene.rules.tuning;
    tuning.tool.radius *= 2;
    sand::Replica plain(scene);
    sand::Replica tuned(scene);
    plain.apply({1, 1, false, {}, Edit::none});
    tuned.apply({1, 1, false, {}, Edit::tuned(tuning)});
    ASSERT_TRUE(sameHeights(samples::fieldOf(plain), samples::fieldOf(tuned)));
    EXPECT_NE(plain.stateHash(), tuned.stateHash());
    sand::Replica joined(scene);
    joined.decodeState(tuned.encodeState());
    EXPECT_EQ(joined.stateHash(), tuned.stateHash());
    EXPECT_EQ(joined.rules(), tuned.rules());
    tuned.apply({1, 2, false, {}, Edit::tuned(scene.rules.tuning)});
    plain.apply({1, 2, false, {}, Edit::none});
    EXPECT_EQ(plain.stateHash(), tuned.stateHash()) << "and back";
}

TEST(Tuning, AToolThatGrowsInTheSandPresses) {
    const scene::Scene scene = samples::flatScene(64, 64);
    sand::Replica replica(scene);
    const std::int32_t middle = 32 * sand::kProbePerCell;
    replica.apply({1, 1, true, {{middle, middle, 2 * sand::kProbePerCell}}, Edit::none});
    sand::Tuning tuning = scene.rules.tuning;
    tuning.tool.radius = 8 * sand::kProbePerCell;
    replica.apply({1, 2, true, {}, Edit::tuned(tuning)});
    EXPECT_LE(samples::fieldOf(replica).height(32, 32), -5 * sand::kUnitsPerCell);
}

}  // namespace
