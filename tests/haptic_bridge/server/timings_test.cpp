// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/server/timings.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "base/input_error.hpp"
#include "tests/support/files/folder_test.hpp"

namespace {

using Timings = test::FolderTest;

std::vector<std::string> linesOf(const std::filesystem::path& file) {
    std::ifstream stream(file);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) {
        lines.push_back(line);
    }
    return lines;
}

TEST_F(Timings, AreBucketsInMicroseconds) {
    base::LiveHistogram period, force;
    for (const int ns : {1'000'000, 1'000'000, 3'000}) {
        period.add(ns);
    }
    haptic_bridge::writeTimings((folder_ / "t.csv").string(), {{"period", &period}, {"force", &force}});
    const std::vector<std::string> lines = linesOf(folder_ / "t.csv");
    ASSERT_EQ(lines.size(), 3U) << "an empty histogram has no line";
    EXPECT_EQ(lines[0], "what,from_us,count");
    // A bucket begins at most an eighth below its durations.
    for (const auto& [line, us, count] : {std::tuple{lines[1], 3.0, 1}, {lines[2], 1000.0, 2}}) {
        const std::size_t comma = line.rfind(',');
        EXPECT_EQ(line.substr(0, 7), "period,");
        const double from = std::stod(line.substr(7));
        EXPECT_LE(from, us);
        EXPECT_GT(from, us * 7 / 8);
        EXPECT_EQ(line.substr(comma + 1), std::to_string(count));
    }
}

TEST_F(Timings, ThatCannotBeWrittenNameTheOption) {
    const base::LiveHistogram period;
    try {
        haptic_bridge::writeTimings((folder_ / "none" / "t.csv").string(), {{"period", &period}});
        FAIL() << "accepted";
    } catch (const base::InputError& error) {
        EXPECT_EQ(std::string(error.what()).rfind("--timings ", 0), 0U) << error.what();
    }
}

}  // namespace
