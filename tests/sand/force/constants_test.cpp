// SPDX-License-Identifier: Apache-2.0
// [force] of a scene file.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "scene/load/scene_file.hpp"
#include "tests/support/files/scene_fixture.hpp"
#include "tests/support/refusal.hpp"

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

/// Returns the bounds in the table of the document: constant, key, default, "least … most", unit.
std::map<std::string, std::pair<double, double>> documentedBounds() {
    std::ifstream document(std::string(SANDWALL_SOURCE_DIR) + "/docs/forces.md");
    const std::string between = " … ";
    std::map<std::string, std::pair<double, double>> bounds;
    for (std::string line; std::getline(document, line);) {
        std::vector<std::string> cells;
        std::istringstream stream(line);
        for (std::string cell; std::getline(stream, cell, '|');) {
            cells.push_back(cell);
        }
        if (cells.size() == 6 && cells[2].rfind(" `", 0) == 0) {
            if (const std::size_t middle = cells[4].find(between); middle != std::string::npos) {
                bounds[cells[2].substr(2, cells[2].size() - 4)] = {std::stod(cells[4]),
                                                                   std::stod(cells[4].substr(middle + between.size()))};
            }
        }
    }
    return bounds;
}

TEST_F(ForceTable, BoundsAreThoseOfTheDocument) {
    auto bounds = documentedBounds();
    for (const sand::ForceKey& key : sand::forceKeys()) {
        if (key.constant != &sand::ForceConstants::unitLength) {  // it has no upper bound
            EXPECT_EQ(bounds[key.name], std::pair(key.lowest, key.highest)) << key.name;
        }
    }
}

TEST_F(ForceTable, RefusesALawThatIsNotFiniteWhereAToolCanBe) {
    const std::string flat = "[field]\ncolumns = 128\n[terrain]\n[tool]\nradius = 0.04\n[force]\n";
    EXPECT_EQ(complaint(flat + "friction = 3\ndepth_exponent = 20000\n"),
              "s.toml:8: depth_exponent 20000 gives a force that is not finite 2 scene units deep; give at most 166");
    EXPECT_EQ(complaint(flat + "depth_exponent = 166\n"), "accepted");
    EXPECT_EQ(complaint(flat + "law = \"control_points\"\nunit_length = 1e-300\n"),
              "s.toml:8: unit_length 1e-300 gives a force that is not finite 2 scene units deep; give at least "
              "2.02e-151");
    EXPECT_EQ(complaint(flat + "law = \"control_points\"\nunit_length = 2.02e-151\n"), "accepted");
    EXPECT_EQ(complaint(flat + "law = \"control_points\"\ndepth_exponent = 20000\n"), "accepted")
        << "a constant of the other law";
    EXPECT_EQ(complaint(flat + "depth_exponent = 20000\nstifness = 3\n").find("s.toml:8: unknown key 'stifness'"), 0U);
    // The longer side counts.
    EXPECT_EQ(complaint("[field]\ncolumns = 64\nrows = 128\nwidth = 1\n[terrain]\n[material]\n[force]\n"
                        "depth_exponent = 167\n"),
              "s.toml:8: depth_exponent 167 gives a force that is not finite 2 scene units deep; give at most 166");
}

TEST_F(ForceTable, LowersTheDefaultExponentOfALargeFieldAndRefusesNoneOfThem) {
    const auto exponent = [&](const std::string& width, const std::string& force = "") {
        return scene::loadScene(write("s.toml", "[field]\ncolumns = 128\nwidth = " + width +
                                                    "\n[terrain]\n[tool]\nradius = 1\n[material]\n" + force))
            .force.depthExponent;
    };
    EXPECT_EQ(exponent("600"), 0.5);
    EXPECT_EQ(exponent("6000", "[force]\nlaw = \"control_points\"\n"), 0.5);
    const double lower = exponent("6000");
    EXPECT_LT(lower, 0.1);
    EXPECT_EQ(exponent("6000", "[force]\nfriction = 10\n"), lower);
    EXPECT_EQ(exponent("6000", fmt::format("[force]\ndepth_exponent = {}\n", lower)), lower) << "it may be given";
    EXPECT_THROW((void)exponent("6000", "[force]\ndepth_exponent = 0.5\n"), base::InputError);
    EXPECT_GT(exponent("6000", "[force]\nstiffness = 1\n"), lower) << "the largest for these constants";
    for (const char* width : {"1e-200", "1e-9", "1e9", "1e100", "1e200"}) {
        EXPECT_NO_THROW((void)scene::loadScene(write(
            "s.toml", fmt::format("[field]\ncolumns = 8\nwidth = {}\n[terrain]\n[tool]\nradius = {}\n", width, width))))
            << width;
    }
}

TEST_F(ForceTable, ReadsALawFromAJournalWithoutRefusingIt) {
    scene::Scene old = scene::loadScene(write("s.toml", kFlat));
    old.force.depthExponent = 20000;
    EXPECT_EQ(scene::Scene::decode(old.encode()).force, old.force) << "an older release has written it";
}

TEST_F(ForceTable, RefusesBytesThatNoSceneFileGives) {
    scene::Scene scene = scene::loadScene(write("s.toml", kFlat));
    scene.statements.reset();  // they would follow the constants
    const auto refusal = [](const base::Bytes& bytes) {
        return test::refusalOf<base::FormatError>([&] { (void)scene::Scene::decode(bytes); });
    };
    const base::Bytes whole = scene.encode();
    EXPECT_EQ(refusal(whole), "nothing");
    const std::array<std::string, 4> last{"law: is 9, which is unknown", "between: is 9, which is unknown",
                                          "friction_direction: is 9, which is unknown",
                                          "literal: is 9, neither 0 nor 1"};
    for (std::size_t i = 0; i < last.size(); ++i) {
        base::Bytes bytes = whole;
        bytes[bytes.size() - last.size() + i] = 9;
        EXPECT_EQ(refusal(bytes), last.at(i));
    }
    for (const sand::ForceKey& key : sand::forceKeys()) {
        scene::Scene wrong = scene;
        wrong.force.*key.constant = key.lowest - 1;
        EXPECT_TRUE(refusal(wrong.encode()).starts_with(std::string(key.name) + ": is ")) << refusal(wrong.encode());
    }
}

}  // namespace
