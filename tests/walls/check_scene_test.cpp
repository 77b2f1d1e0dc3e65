// SPDX-License-Identifier: Apache-2.0
// What sandwall-check says of a scene.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/processes/run_program.hpp"
#include "tests/walls/sample_walls.hpp"

namespace walls {
namespace {

std::string fileOf(const std::string& wall) { return (configFolder() / wall).string(); }

TEST(CheckScene, PrintsTheCellsOfASceneAlone) {
    const std::filesystem::path scene = std::filesystem::path(testing::TempDir()) / "sandwall_check_cells.toml";
    std::ofstream(scene) << "[field]\ncolumns = 48\nrows = 20\nwidth = 12\n[terrain]\n[tool]\nradius = 0.5\n";
    const support::Ran ran = support::runProgram("sandwall-check", "--cells --scene " + scene.string());
    EXPECT_EQ(ran.status, 0);
    EXPECT_EQ(ran.output, "48 20 0.25\n");
    EXPECT_EQ(support::runProgram("sandwall-check", "--cells").output,
              "sandwall-check: --cells: name a scene with --scene\n");
}

TEST(CheckScene, PrintsWhatAStepOfTheToolCostsAbout) {
    const std::filesystem::path scene = std::filesystem::path(testing::TempDir()) / "sandwall_check_cost.toml";
    for (const auto& [field, part] :
         {std::pair("columns = 700\nrows = 30\n", "512 x 30"), {"columns = 48\n", "48 x 48"}}) {
        std::ofstream(scene) << "[field]\n" << field << "[terrain]\n[material]\n[tool]\nradius = 0.2\n";
        const support::Ran ran = support::runProgram("sandwall-check", "--scene " + scene.string());
        EXPECT_EQ(ran.status, 0);
        const std::string line = std::string(
                                     "a step in which the tool digs takes ≈ [0-9.]+ ms of one core for [0-9]+ "
                                     "sweeps at most; it was measured for [0-9.]+ s on ") +
                                 part + " cells\n";
        EXPECT_TRUE(std::regex_search(ran.output, std::regex(line))) << ran.output;
        const std::regex tools(
            "this tool follows the hand (up to a radius of ≈ [0-9.]+ \\([0-9.]+ cells.*\\)|at no radius of 4 cells or "
            "more); its step takes at most 250 ms up to a radius of ≈ [0-9.]+ \\([0-9.]+ cells.*\\)\n");
        EXPECT_TRUE(std::regex_search(ran.output, tools)) << ran.output;
    }
    std::ofstream(scene) << "[field]\ncolumns = 48\n[terrain]\n[tin]\n[material]\n[tool]\nradius = 0.2\n";
    const std::string ofTin = support::runProgram("sandwall-check", "--scene " + scene.string()).output;
    EXPECT_EQ(ofTin.find("a step in which"), std::string::npos) << "the steps of a TIN are not measured in parts";
    EXPECT_TRUE(std::regex_search(
        ofTin, std::regex("this tool follows the hand .*; its step takes at most 250 ms up to a radius of .*\n")))
        << ofTin;
    std::filesystem::remove(scene);
}

TEST(CheckScene, ChecksASceneAndPrintsTheUnitsOfItsTerrain) {
    const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "sandwall_check_scene";
    std::filesystem::create_directory(folder);
    const std::string scene = (folder / "hills.toml").string(), grid = (folder / "t.asc").string();
    std::ofstream(scene) << "[terrain]\nkind = \"esri_ascii\"\nfile = \"t.asc\"\n[material]\n[tool]\nradius = 30\n";
    std::ofstream(grid)
        << "ncols 2\nnrows 2\nxllcorner 500000\nyllcorner 5000000\ncellsize 10\nNODATA_value -1\n1 2\n3 -1\n";
    const support::Ran ran = support::runProgram("sandwall-check", "--scene " + scene);
    EXPECT_EQ(ran.status, 0);
    EXPECT_TRUE(ran.output.starts_with("scene 'hills': 2 x 2 cells of 10\n" + grid +
                                       ": units of unknown length across (no coordinate system), the same up (no unit "
                                       "of heights), no data -1 in 25 % of cells\n"))
        << ran.output;
    std::ofstream(grid) << "ncols 2\n";
    EXPECT_EQ(support::runProgram("sandwall-check", "--scene " + scene).status, 2);
    EXPECT_EQ(support::runProgram("sandwall-check", fileOf("desktop.toml") + " --scene " + scene).status, 2);
    std::filesystem::remove_all(folder);
}

/// Returns the numbers of the line that begins with `process` in the output of --memory.
std::vector<std::int64_t> memoryOf(const std::string& output, const std::string& process) {
    std::istringstream lines(output);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string first;
        if (words >> first && first == process) {
            return {std::istream_iterator<std::int64_t>(words), {}};
        }
    }
    return {};
}

TEST(CheckScene, PrintsTheMemoryOfEachProcess) {
    const std::filesystem::path scene = std::filesystem::path(testing::TempDir()) / "sandwall_check_memory.toml";
    std::ofstream(scene) << "[field]\ncolumns = 2048\n[terrain]\n[material]\n[tool]\nradius = 0.05\n";
    const std::string session = fileOf("tiled_3x4.toml") + " --scene " + scene.string();
    const support::Ran ran = support::runProgram("sandwall-check", session + " --memory");
    EXPECT_EQ(ran.status, 0);
    EXPECT_EQ(std::count(ran.output.begin(), ran.output.end(), '\n'), 14) << ran.output;
    for (const char* process : {"server", "master", "1", "12"}) {
        const std::vector<std::int64_t> figures = memoryOf(ran.output, process);
        ASSERT_EQ(figures.size(), 4U) << ran.output;
        EXPECT_GT(figures[0], std::int64_t{8} * 2048 * 2048) << process;
        EXPECT_GT(figures[2], figures[0]) << process << ": all sand moves";
        EXPECT_LT(figures[3], figures[0]) << process;
    }
    const std::string without = support::runProgram("sandwall-check", session + " --memory --no-checkpoints").output;
    EXPECT_LT(memoryOf(without, "master")[2], memoryOf(ran.output, "master")[2] - std::int64_t{12} * 2048 * 2048)
        << "the copy for a checkpoint has heights and fluxes";
    EXPECT_EQ(memoryOf(without, "12"), memoryOf(ran.output, "12"));
    EXPECT_EQ(support::runProgram("sandwall-check", "--memory --scene " + scene.string()).status, 2);

    const std::string table = support::runProgram("sandwall-check", session).output;
    for (const char* row :
         {"haptic server +[0-9.]+ [MG]iB +[0-9.]+ [MG]iB +[0-9.]+ [MG]iB\n", "master  ", "rank of 1024 x 768 pixels ",
          "this machine: server, master, 12 ranks ", "the start takes ≈ [0-9.]+ s"}) {
        EXPECT_TRUE(std::regex_search(table, std::regex(row))) << row << "\n" << table;
    }
    std::filesystem::remove(scene);
}

}  // namespace
}  // namespace walls
