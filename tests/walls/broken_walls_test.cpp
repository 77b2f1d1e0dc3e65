// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>

#include "tests/support/processes/run_program.hpp"
#include "tests/walls/sample_walls.hpp"

namespace walls {
namespace {

/// Walls with usual mistakes.
std::filesystem::path brokenWalls() { return SANDWALL_SOURCE_DIR "/tests/walls/broken"; }

/// Error that the first comment of a broken wall announces: "# expect: 12: eye_separation must be positive".
struct Promise {
    std::string line, message;
};

Promise promiseOf(const std::filesystem::path& file) {
    std::ifstream stream(file);
    std::string first, why;
    std::getline(stream, first);
    std::getline(stream, why);
    const std::string start = "# expect: ";
    const std::size_t colon = first.find(": ", start.size());
    if (first.rfind(start, 0) != 0 || colon == std::string::npos || why.size() < 10) {
        return {};
    }
    const Promise promise{first.substr(start.size(), colon - start.size()), first.substr(colon + 2)};
    const bool numbered = promise.line.find_first_not_of("0123456789") == std::string::npos;
    return numbered && promise.message.size() >= 10 ? promise : Promise{};
}

/// Loads a wall and checks the error. Returns the error's line, or "" if the wall is accepted.
std::string complaintAbout(const std::filesystem::path& file) {
    try {
        (void)loadWall(file);
    } catch (const base::InputError& error) {
        return error.what();
    }
    return "";
}

TEST(BrokenWalls, GiveOneClearLineEach) {
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(brokenWalls())) {
        SCOPED_TRACE(entry.path().filename().string());
        ++count;
        const Promise promise = promiseOf(entry.path());
        ASSERT_FALSE(promise.line.empty()) << "the first two lines must say what is expected, and why";
        const std::string line = complaintAbout(entry.path());
        EXPECT_EQ(line.find('\n'), std::string::npos) << line;
        EXPECT_EQ(line.rfind(fmt::format("{}:{}: ", entry.path().string(), promise.line), 0), 0U) << line;
        EXPECT_NE(line.find(promise.message), std::string::npos) << line;
    }
    EXPECT_GE(count, 70);
}

TEST(BrokenWalls, AreRefusedByTheProgramInTheSameLine) {
    const std::filesystem::path file = brokenWalls() / "eye_misspelt.toml";
    const support::Ran ran = support::runProgram("sandwall-check", file.string());
    EXPECT_EQ(ran.status, 2);
    EXPECT_EQ(ran.output, "sandwall-check: " + complaintAbout(file) + "\n");
}

TEST(BrokenWalls, BecomeWholeByOneEdit) {
    // The frame of all broken walls is valid, so that each file is refused only for its one mistake.
    std::ifstream stream(brokenWalls() / "eye_misspelt.toml");
    std::string text{std::istreambuf_iterator<char>(stream), {}};
    text.replace(text.find("eyes ="), 4, "eye ");
    EXPECT_EQ(parseWall(text, "mended.toml").ranks(), 4);
}

}  // namespace
}  // namespace walls
