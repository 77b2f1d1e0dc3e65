// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/files/folder_test.hpp"
#include "tests/support/processes/run_program.hpp"
#include "tests/walls/sample_walls.hpp"
#include "walls/wall.hpp"

namespace {

class NewWall : public test::FolderTest {
protected:
    [[nodiscard]] std::string file(const std::string& name = "my_wall.toml") const { return (folder_ / name).string(); }
    [[nodiscard]] static support::Ran write(const std::string& grid, const std::string& file) {
        return support::runProgram("sandwall-check", fmt::format("--new '{}' '{}'", grid, file));
    }
};

int corners(const std::string& report) {
    int count = 0;
    for (std::size_t at = report.find("  on r"); at != std::string::npos; at = report.find("  on r", at + 1)) {
        ++count;
    }
    return count;
}

TEST_F(NewWall, ShowsAllCornersOfTheSandWhateverItsGrid) {
    for (const auto& [grid, tiles] :
         {std::pair{"1x1", 1}, {"2x2", 4}, {"3x4", 12}, {"1x8", 8}, {"8x1", 8}, {"32x32", 1024}}) {
        const std::string wall = file(fmt::format("{}.toml", grid));
        const support::Ran ran = write(grid, wall);
        EXPECT_EQ(ran.status, 0) << ran.output;
        EXPECT_EQ(walls::loadWall(wall).ranks(), tiles);
        EXPECT_EQ(walls::loadWall(wall).name, grid);
        EXPECT_EQ(corners(ran.output), 4) << ran.output;
        const walls::Wall made = walls::loadWall(wall);
        walls::expectShown(made, walls::stageToRoom(made.stage, 1, 1, 0), shapes::boxOutline({1, 1}, 0, 0));
        EXPECT_EQ(ran.output.find("warning"), std::string::npos) << ran.output;
    }
}

TEST_F(NewWall, TakesTheFileBeforeOrBehindTheOption) {
    for (const char* words : {"'{}' --new 2x2", "--new 2x2 '{}'", "'{}' --new=2x2"}) {
        const support::Ran ran = support::runProgram("sandwall-check", fmt::format(fmt::runtime(words), file()));
        EXPECT_EQ(ran.status, 0) << ran.output;
        EXPECT_TRUE(std::filesystem::remove(file())) << words;
    }
}

TEST_F(NewWall, ReplacesNoFile) {
    std::ofstream(file()) << "mine";
    const support::Ran ran = write("2x2", file());
    EXPECT_EQ(ran.status, 2);
    EXPECT_EQ(ran.output, fmt::format("sandwall-check: {}: exists and stays; give --new another file\n", file()));
    EXPECT_EQ(std::filesystem::file_size(file()), 4U);
}

TEST_F(NewWall, RefusesWhatIsNoGrid) {
    for (const char* grid : {"2", "2x", "x2", "0x1", "1x33", "2x2x2", "-1x2", "2 x 2", "99999999999x1", "two"}) {
        const support::Ran ran = write(grid, file());
        EXPECT_EQ(ran.status, 2) << grid;
        EXPECT_EQ(
            ran.output,
            fmt::format("sandwall-check: --new: '{}' must be ROWSxCOLUMNS, such as 2x3, each from 1 to 32\n", grid));
        EXPECT_FALSE(std::filesystem::exists(file()));
    }
    EXPECT_EQ(support::runProgram("sandwall-check", "--new 2x2").status, 2) << "no file";
}

TEST_F(NewWall, TakesANameThatNeedsNoEscapes) {
    const std::string odd = file("my \"wall\".toml");
    EXPECT_EQ(write("1x2", odd).status, 0);
    EXPECT_EQ(walls::loadWall(odd).name, "wall");
}

}  // namespace
