// SPDX-License-Identifier: Apache-2.0
// TINs whose vertices are the points of a survey, and scenes that a TIN cannot hold.
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <tuple>
#include <vector>

#include "base/input_error.hpp"
#include "sand/replica.hpp"
#include "scene/load/scene_file.hpp"
#include "tests/support/files/folder_test.hpp"

namespace {

class SurveyScene : public test::FolderTest {
protected:
    void writeDunes(const std::string& terrain, const std::string& tin) const {
        std::ofstream(folder_ / "scene.toml")
            << "[field]\ncolumns = 64\nwidth = 2.0\n[terrain]\nkind = \"dunes\"\nheight = 0.3\n"
            << terrain << "[tin]\n"
            << tin << "[material]\ntalus_deg = 34\n[tool]\nradius = 0.1\n";
    }
};

TEST_F(SurveyScene, IsMadeOfTheSurveyPointsThemselves) {
    std::ofstream(folder_ / "survey.csv") << "x,y,z\n100,200,3\n110,200,5\n110,205,7\n104,203,4\n";
    std::ofstream(folder_ / "points.toml") << "[terrain]\nkind = \"points\"\nfile = \"survey.csv\"\n[tin]\ncell = 0.5\n"
                                              "[material]\ntalus_deg = 34\n[tool]\nradius = 1\n";
    const scene::Scene read = scene::loadScene(folder_ / "points.toml");
    ASSERT_NE(read.tin, nullptr);
    EXPECT_EQ(read.rules.columns, 20);
    EXPECT_EQ(read.rules.rows, 10);
    ASSERT_EQ(read.tin->places.size(), 7U)
        << "three points at corners, one within the field, the fourth corner, and two places on sides of 20 cells";
    const sand::Replica replica(read);
    const auto height = [&](double x, double y) {
        return replica.surface().height((x - 100) / 0.5 * 256, (y - 200) / 0.5 * 256) * 0.5 / 65536;
    };
    EXPECT_DOUBLE_EQ(height(100, 200), 3);
    EXPECT_DOUBLE_EQ(height(110, 200), 5);
    EXPECT_DOUBLE_EQ(height(104, 203), 4);
    EXPECT_DOUBLE_EQ(height(100, 205), 4) << "a corner without a point is as high as the nearest point";
}

TEST_F(SurveyScene, SaysHowManySurveyPointsItDoesNotTellApart) {
    const auto warnings = [&](const std::string& cell) {
        std::ofstream(folder_ / "survey.csv") << "5.001 5 51\n0 0 0\n0.002 0 -3\n10 0 0\n0 10 0\n5 5 1\n5.002 5 21\n";
        std::ofstream(folder_ / "points.toml")
            << "[terrain]\nkind = \"points\"\nfile = \"survey.csv\"\n[tin]\ncell = " << cell
            << "\n[material]\ntalus_deg = 34\n[tool]\nradius = 10\n";
        const scene::Scene read = scene::loadScene(folder_ / "points.toml");
        // With the missing corner. A side of 100 cells has six places more, at most 16 cells apart.
        EXPECT_EQ(read.tin->places.size(), read.warnings.empty() ? 8U + 4 * 6 : 5U);
        return read.warnings;
    };
    EXPECT_EQ(warnings("5"),
              std::vector{(folder_ / "survey.csv").string() +
                          ": 3 points lie within 0.0195 of another, which a TIN of such cells cannot separate; the "
                          "first in the file was taken, others were up to 50 higher or lower; set a smaller "
                          "cell in [tin]"});
    EXPECT_EQ(warnings("0.1"), std::vector<std::string>{});
}

TEST_F(SurveyScene, RefusesWhatItCannotHoldInOneLine) {
    const auto complaint = [this](const std::string& tin, const std::string& more) -> std::string {
        writeDunes(more, tin);
        try {
            (void)scene::loadScene(folder_ / "scene.toml");
        } catch (const base::InputError& error) {
            return error.what();
        }
        return "nothing";
    };
    for (const auto& [tin, more, part] :
         {std::tuple{"max_error = -1\n", "", "max_error"}, std::tuple{"vertices = 3\n", "", "vertices"},
          std::tuple{"spacing = 0\n", "", "spacing"}, std::tuple{"", "layer = 0.1\n", "a TIN has no rock"},
          std::tuple{"colour = 1\n", "", "colour"}}) {
        const std::string said = complaint(tin, more);
        EXPECT_NE(said.find(part), std::string::npos) << said;
        EXPECT_NE(said.find("scene.toml:"), std::string::npos) << said;
        EXPECT_EQ(said.find('\n'), std::string::npos) << said;
    }
    std::ofstream(folder_ / "survey.csv") << "0 0 0\n10 0 0\n0 10 0\n";
    std::ofstream(folder_ / "points.toml")
        << "[terrain]\nkind = \"points\"\nfile = \"survey.csv\"\nlayer = 0.1\n[tin]\n"
           "[material]\n[tool]\nradius = 1\n";
    try {
        (void)scene::loadScene(folder_ / "points.toml");
        FAIL() << "accepted";
    } catch (const base::InputError& error) {
        EXPECT_NE(std::string(error.what()).find("points.toml:5: a TIN has no rock"), std::string::npos)
            << error.what();
    }
}

}  // namespace
