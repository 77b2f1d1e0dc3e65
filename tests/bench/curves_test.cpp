// SPDX-License-Identifier: Apache-2.0
// Tests the benchmark program itself. Every curve must write a table that a script can read, and refuse bad input in
// one line. The values of the curves are for the report and are not tested here.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/processes/run_program.hpp"

namespace {

using support::runProgram;

/// A temporary file of this process, removed with the object.
class TemporaryFile {
public:
    explicit TemporaryFile(const std::string& name)
        : path_(std::filesystem::temp_directory_path() / (std::to_string(getpid()) + name)) {}
    ~TemporaryFile() { std::filesystem::remove(path_); }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    [[nodiscard]] std::string path() const { return path_.string(); }
    [[nodiscard]] std::vector<std::string> lines() const {
        std::ifstream file(path_);
        std::vector<std::string> lines;
        for (std::string line; std::getline(file, line);) {
            lines.push_back(line);
        }
        return lines;
    }

private:
    std::filesystem::path path_;
};

std::size_t fields(const std::string& line) {
    bool quoted = false;
    std::size_t count = 1;
    for (const char c : line) {
        quoted ^= c == '"';
        count += c == ',' && !quoted ? 1 : 0;
    }
    return count;
}

/// The table must begin with comments about the origin of its numbers. Then come a line of names and at least one row,
/// all with the same number of fields.
void expectTable(const std::vector<std::string>& lines, const std::string& command) {
    const auto first = std::find_if(lines.begin(), lines.end(), [](const auto& line) { return line.front() != '#'; });
    ASSERT_NE(first, lines.end()) << "the file has no table";
    for (const char* fact : {"machine", "compiler", "flags", "code path", "seed", "command", "date"}) {
        const std::string start = std::string("# ") + fact + ": ";
        const auto comment = std::find_if(lines.begin(), first, [&](const auto& l) { return l.starts_with(start); });
        ASSERT_NE(comment, first) << "no comment names the " << fact;
        EXPECT_GT(comment->size(), start.size());
    }
    EXPECT_NE(std::find(lines.begin(), first, "# command: sandwall-bench " + command), first);
    EXPECT_GE(std::distance(first, lines.end()), 2) << "the table has no row";
    for (auto line = first; line != lines.end(); ++line) {
        EXPECT_EQ(fields(*line), fields(*first)) << *line;
    }
}

class Curve : public testing::TestWithParam<const char*> {};

TEST_P(Curve, WritesATableWithItsOrigin) {
    const TemporaryFile csv("curve.csv");
    const std::string command = std::string(GetParam()) + " --runs 2 --seed 3 --out " + csv.path();
    const support::Ran ran = runProgram("sandwall-bench", command);
    ASSERT_EQ(ran.status, 0) << ran.output;
    expectTable(csv.lines(), command);
    EXPECT_FALSE(ran.output.empty()) << "the program printed no progress on stderr";
}

// Each curve is as small as it can be and still has a row.
INSTANTIATE_TEST_SUITE_P(Bench, Curve,
                         testing::Values("work-precision --sizes 8,16", "error-at-rest --sizes 8,16",
                                         "sweeps --sizes 16", "anisotropy --sizes 16", "decay --sizes 16",
                                         "height-bits --sizes 16", "band --sizes 16", "mass-drift --sizes 16",
                                         "budget --sizes 16", "edit --sizes 64", "dig --sizes 240",
                                         "throughput --sizes 32", "rest --sizes 16", "rest-moving --sizes 16",
                                         "hashes --sizes 16", "force-rate --sizes 192", "force-work --sizes 64",
                                         "between-stability", "tap", "force-loop", "parts --sizes 32",
                                         "certificate --sizes 16", "tin-imprint --sizes 104", "tin-simplify --sizes 32",
                                         "extremes", "explain " SANDWALL_SOURCE_DIR "/scenes/writing.toml"),
                         [](const auto& curve) {
                             std::string name = curve.param;
                             name = name.substr(0, name.find(' '));
                             std::replace(name.begin(), name.end(), '-', '_');
                             return name;
                         });

// The tool has a radius of 307 cells and may heap sand up to 1229 cells. Volumes on 2048 x 2048 cells can hold a height
// of only 42 cells.
TEST(SandwallBench, ExplainsATinWhoseVolumesHoldLessThanItsToolIsHigh) {
    const TemporaryFile scene("tin.toml");
    std::ofstream(scene.path()) << "steps_per_second = 1000\n[field]\ncolumns = 2048\n[terrain]\n[tin]\nwidest = 0\n"
                                   "vertices = 100\nspacing = 0.1\n[material]\nsettling_time = 1000\n[tool]\n"
                                   "radius = 0.3\n";
    const support::Ran ran = runProgram("sandwall-bench", "explain " + scene.path() + " --runs 2");
    EXPECT_EQ(ran.status, 0) << ran.output;
    EXPECT_NE(ran.output.find("step,everything moving,yes,"), std::string::npos) << ran.output;
}

TEST(SandwallBench, FollowsNoLinkAndReplacesAFileToWhichOthersMayWrite) {
    const TemporaryFile other("other.csv"), link("link.csv");
    std::ofstream(other.path()) << "of another program\n";
    std::filesystem::permissions(other.path(), std::filesystem::perms(0666));
    std::filesystem::create_symlink(other.path(), link.path());
    EXPECT_EQ(runProgram("sandwall-bench", "hashes --sizes 16 --out " + link.path()).status, 2);
    EXPECT_EQ(other.lines(), std::vector<std::string>{"of another program"});
    EXPECT_EQ(runProgram("sandwall-bench", "hashes --sizes 16 --out " + other.path()).status, 0);
    EXPECT_EQ(std::filesystem::status(other.path()).permissions() & std::filesystem::perms(0022),
              std::filesystem::perms::none);
}

TEST(SandwallBench, RefusesInOneLineWhatItCannotDo) {
    for (const auto& [arguments, part] : std::vector<std::pair<std::string, std::string>>{
             {"", "ubcommand"},
             {"speed", "ubcommand"},
             {"rest --sizes 4", "--sizes"},
             {"rest --sizes 64,wide", "wide"},
             {"rest --runs 0", "--runs"},
             {"rest --seed -1", "--seed"},
             {"rest --sizes 16 --out /nowhere/rest.csv", "/nowhere/rest.csv"},
             {"throughput --path x86-64-v9", "x86-64-v4"},
             {"throughput --rows G,H", "there is no \"H\"; choose from copy, G, "},
             {"guarded-sweep --rows touch/0/7", "there is no \"touch/0/7\"; choose from touch/0/0.5, "},
             {"explain", "SCENE"},
             {"explain nowhere.toml", "nowhere.toml"},
             {"explain nowhere.toml --sizes 16", "--sizes"}}) {
        const support::Ran ran = runProgram("sandwall-bench", arguments);
        EXPECT_EQ(ran.status, 2) << arguments << ": " << ran.output;
        EXPECT_EQ(std::count(ran.output.begin(), ran.output.end(), '\n'), 1) << arguments << ": " << ran.output;
        EXPECT_NE(ran.output.find(part), std::string::npos) << arguments << ": " << ran.output;
    }
}

// Each scheme must have one hash, in whatever way the sand is computed.
TEST(SandwallBench, ComputesOneHashPerScheme) {
    const TemporaryFile csv("hashes.csv");
    ASSERT_EQ(runProgram("sandwall-bench", "hashes --sizes 16 --out " + csv.path()).status, 0);
    std::vector<std::string> seen;
    int rows = 0;
    for (const std::string& line : csv.lines()) {
        if (line.front() != '#' && !line.starts_with("compiler")) {
            seen.push_back(line.substr(line.rfind(',') + 1));
            ++rows;
        }
    }
    EXPECT_GE(rows, 48);
    std::sort(seen.begin(), seen.end());
    seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
    EXPECT_EQ(seen.size(), 2U);
}

}  // namespace
