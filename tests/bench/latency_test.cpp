// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "tests/support/processes/run_program.hpp"

namespace {

using support::runProgram;

std::vector<std::string> words(const std::string& line) {
    std::istringstream stream(line);
    std::vector<std::string> cells;
    for (std::string cell; std::getline(stream, cell, ',');) {
        cells.push_back(cell);
    }
    return cells;
}

TEST(LatencyBench, MeasuresAWallBesideTheFloor) {
    const auto file =
        std::filesystem::temp_directory_path() / ("sandwall-latency-" + std::to_string(getpid()) + ".csv");
    const support::Ran ran = runProgram("sandwall-bench",
                                        "latency --seconds 1 --warm-up 0 --walls portable --links "
                                        "impaired --loads still --seed 5 --out " +
                                            file.string());
    ASSERT_EQ(ran.status, 0) << ran.output;
    std::ifstream stream(file);
    std::string line;
    while (std::getline(stream, line) && line.starts_with("#")) {
    }
    const std::vector<std::string> titles = words(line);
    std::getline(stream, line);
    const std::vector<std::string> cells = words(line);
    ASSERT_EQ(titles.size(), cells.size());
    EXPECT_FALSE(std::getline(stream, line)) << "one wall, one link and one load were chosen";
    std::map<std::string, std::string> row;
    for (std::size_t i = 0; i < titles.size(); ++i) {
        row[titles[i]] = cells[i];
    }
    EXPECT_EQ(row["wall"], "portable");
    EXPECT_EQ(row["nodes"], "1");
    EXPECT_EQ(row["link"], "impaired");
    EXPECT_EQ(row["load"], "still");
    EXPECT_EQ(row["eye_pixels"], "64x48");
    EXPECT_EQ(row["paper_mean"], "24.9");
    EXPECT_EQ(row["paper_stddev"], "14.8");
    EXPECT_GT(std::stoi(row["wall_count"]), 0);
    EXPECT_GE(std::stoi(row["master_count"]), std::stoi(row["wall_count"]));
    EXPECT_GE(std::stod(row["master_mean"]), 3) << "the link's own delay in both directions";
    EXPECT_GE(std::stod(row["floor_message_mean"]), 3);
    EXPECT_EQ(row["divergences"], "0");
    std::filesystem::remove(file);
}

TEST(LatencyBench, RefusesInOneLineWhatItCannotDo) {
    for (const auto& [arguments, named] : {std::pair{"--walls cave", "--walls: 'cave'"},
                                           {"--seconds 0", "--seconds: 0 must be from 1 to 3600"},
                                           {"--out /nowhere/a.csv", "/nowhere/a.csv"},
                                           {"--secnods 3", "--secnods 3"}}) {
        const support::Ran ran = runProgram("sandwall-bench", std::string("latency ") + arguments);
        EXPECT_EQ(ran.status, 2) << ran.output;
        EXPECT_NE(ran.output.find(named), std::string::npos) << ran.output;
        EXPECT_EQ(std::count(ran.output.begin(), ran.output.end(), '\n'), 1) << ran.output;
    }
}

}  // namespace
