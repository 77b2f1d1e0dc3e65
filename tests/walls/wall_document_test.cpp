// SPDX-License-Identifier: Apache-2.0
// docs/wall_files.md: every example must be a valid wall, and the walls must have the measures that the text gives.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/processes/run_program.hpp"
#include "tests/walls/sample_walls.hpp"

namespace walls {
namespace {

std::string document() {
    std::ifstream page(std::filesystem::path(SANDWALL_SOURCE_DIR) / "docs/wall_files.md");
    return {std::istreambuf_iterator<char>(page), {}};
}

std::vector<std::string> examples() {
    const std::string text = document();
    const std::string open = "```toml\n";
    std::vector<std::string> blocks;
    for (std::size_t start = text.find(open); start != std::string::npos; start = text.find(open, start)) {
        start += open.size();
        blocks.push_back(text.substr(start, text.find("```", start) - start));
    }
    return blocks;
}

/// Completes a part of a wall file with the missing tables of the first example, which is a whole wall file.
std::string completed(const std::string& part, const std::string& whole) {
    std::string text = part;
    for (const std::string table : {"[viewer]", "[grid]", "[stage]"}) {
        const std::size_t start = whole.find(table);
        if (part.find(table) == std::string::npos && start != std::string::npos) {
            text += fmt::format("\n{}\n", whole.substr(start, whole.find("\n\n", start) - start));
        }
    }
    return text;
}

TEST(WallDocument, LeadsFromATapeMeasureToAWallThatPasses) {
    ASSERT_FALSE(examples().empty());
    const std::filesystem::path file =
        std::filesystem::path(testing::TempDir()) / ("stranger_" + std::to_string(::getpid()) + ".toml");
    std::ofstream(file) << examples().front();
    const support::Ran check = support::runProgram("sandwall-check", file.string());
    EXPECT_EQ(check.status, 0) << check.output;
    EXPECT_EQ(check.output.find("no tile"), std::string::npos) << "all corners of the sand are seen\n" << check.output;
    EXPECT_NE(check.output.find("measured 2 across of 7.0 mm, 2 down of 7.0 mm"), std::string::npos) << check.output;
    std::filesystem::remove(file);

    const Wall wall = parseWall(examples().front(), "docs/wall_files.md");
    ASSERT_EQ(wall.ranks(), 4);
    for (const Tile& tile : wall.tiles) {
        EXPECT_NEAR(tile.screen.width(), 1.018, 1e-12);
        EXPECT_NEAR(tile.screen.height(), 0.573, 1e-12);
        EXPECT_EQ(tile.pixels, glm::ivec2(1920, 1080));
        EXPECT_NEAR(tile.screen.distanceTo(wall.viewer.eye), 2.5, 1e-12);
    }
    // Two bezels of 3.5 mm are between neighbouring lit areas.
    EXPECT_NEAR(wall.tiles[1].screen.lowerLeft.x - wall.tiles[0].screen.lowerRight.x, 2 * 0.0035, 1e-12);
    EXPECT_NEAR(wall.tiles[0].screen.lowerLeft.y - wall.tiles[2].screen.upperLeft.y, 2 * 0.0035, 1e-12);
    EXPECT_NEAR(wall.tiles[2].screen.lowerLeft.y, 0.80, 1e-12) << "above the floor";
    EXPECT_NEAR(wall.tiles[0].screen.lowerLeft.x, -wall.tiles[1].screen.lowerRight.x, 1e-12) << "in the middle";
}

TEST(WallDocument, HasExamplesThatAreWalls) {
    const std::vector<std::string> blocks = examples();
    ASSERT_GE(blocks.size(), 6U);
    for (const std::string& block : blocks) {
        EXPECT_NO_THROW((void)parseWall(completed(block, blocks.front()), "docs/wall_files.md")) << block;
    }
}

TEST(WallDocument, NamesEveryMode) {
    const std::string text = document();
    for (const std::string_view name : base::namesOf<Stereo>()) {
        EXPECT_NE(text.find(fmt::format("`{}`", name)), std::string::npos) << name;
    }
}

// The page shows some samples. The first line of each file says what it is, so that a new sample is one file.
TEST(WallDocument, NamesSamplesThatExistAndEachSampleSaysWhatItIs) {
    const std::string text = document();
    const std::size_t table = text.find("| file | display |");
    ASSERT_NE(table, std::string::npos);
    std::istringstream rows(text.substr(table, text.find("\n\n", table) - table));
    std::set<std::string> named;
    for (std::string row; std::getline(rows, row);) {
        const std::string files = row.substr(0, row.find('|', 1));
        for (std::size_t at = files.find('`'); at != std::string::npos; at = files.find('`', at + 1)) {
            const std::size_t end = files.find('`', at + 1);
            named.insert(files.substr(at + 1, end - at - 1) + ".toml");
            at = end;
        }
    }
    const std::vector<std::string> samples = configNames();
    EXPECT_FALSE(named.empty());
    for (const std::string& name : named) {
        EXPECT_NE(std::ranges::find(samples, name), samples.end()) << name;
    }
    for (const std::string& name : samples) {
        std::ifstream file(configFolder() / name);
        std::string first;
        std::getline(file, first);
        EXPECT_TRUE(first.starts_with("# ") && first.size() > 10) << name << " begins with: " << first;
    }
}

}  // namespace
}  // namespace walls
