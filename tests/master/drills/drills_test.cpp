// SPDX-License-Identifier: Apache-2.0
#include "master/drills/drills.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "master/measure/failure_report.hpp"
#include "tests/support/files/folder_test.hpp"

namespace {

using lockstep::Fault;
using master::Drill;

class Drills : public test::FolderTest {
protected:
    [[nodiscard]] std::string read(const std::string& name) const {
        std::ifstream stream(folder_ / name);
        return {std::istreambuf_iterator<char>(stream), {}};
    }

    const std::vector<Drill> drills_{{"die", {.kind = Fault::Kind::die, .rank = 2, .frame = 5}},
                                     {"slow", {.kind = Fault::Kind::slow, .rank = 1, .frame = 5}},
                                     {"garbage", {.kind = Fault::Kind::garbage, .frame = 7}}};
};

TEST_F(Drills, AreOnDiskBeforeTheirFrame) {
    EXPECT_TRUE(master::beginDrills(drills_, 4, folder_).empty());
    EXPECT_EQ(read("drills.done"), "");
    EXPECT_TRUE(master::beginDrills(drills_, 5, folder_).empty()) << "a rank's fault is not for the link";
    EXPECT_EQ(read("drills.done"), "die\n");
    EXPECT_EQ(master::beginDrills(drills_, 7, folder_), std::vector{drills_[2].fault});
    EXPECT_EQ(read("drills.done"), "die\ngarbage\n");
}

TEST_F(Drills, HappenOnceInASessionThatIsTakenUpAgain) {
    (void)master::beginDrills(drills_, 5, folder_);
    const std::vector<Drill> left = master::withoutDone(drills_, folder_, true);
    ASSERT_EQ(left.size(), 2U);
    EXPECT_EQ(left[0].text, "slow") << "slow drawing continues after a resume";
    EXPECT_EQ(left[1].text, "garbage");
}

TEST_F(Drills, HappenOnceAlsoBehindALineThatACrashHasTorn) {
    std::ofstream(folder_ / "drills.done") << "garb";
    (void)master::beginDrills(drills_, 5, folder_);
    const std::vector<Drill> left = master::withoutDone(drills_, folder_, true);
    ASSERT_EQ(left.size(), 2U);
    EXPECT_EQ(left[1].text, "garbage");
}

TEST_F(Drills, OfAnEarlierSessionAreForgotten) {
    (void)master::beginDrills(drills_, 5, folder_);
    EXPECT_EQ(master::withoutDone(drills_, folder_, false).size(), 3U);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "drills.done"));
}

TEST_F(Drills, LeaveAReportThatIsWhole) {
    ASSERT_TRUE(master::writeFailure({"broken", 2, "node\x80", "r1c2", "a line"}, folder_));
    const nlohmann::json json = nlohmann::json::parse(read("failure.json"));
    EXPECT_EQ(json["what"], "broken");
    EXPECT_EQ(json["rank"], 2);
    EXPECT_EQ(json["tile"], "r1c2");
    EXPECT_EQ(json["message"], "a line");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "failure.json.new"));
    EXPECT_FALSE(master::writeFailure({"broken", 2, "node", "r1c2", "a line"}, folder_ / "none"));
}

}  // namespace
