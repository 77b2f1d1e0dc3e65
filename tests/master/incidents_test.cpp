// SPDX-License-Identifier: Apache-2.0
#include "master/incidents.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

class IncidentFileTest : public testing::Test {
protected:
    void SetUp() override { std::filesystem::create_directories(folder); }
    void TearDown() override { std::filesystem::remove_all(folder); }
    [[nodiscard]] bool written() const { return std::filesystem::exists(folder / "incidents.json"); }

    const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "sandwall_incidents_test";
};

TEST_F(IncidentFileTest, IsReadByTheTryThatGoesOnAndByNoSessionThatBeginsAnew) {
    master::Incidents some{
        .divergences = 3, .healed = 2, .serverDivergences = 1, .links = 6, .reconnects = 4, .stands = 1};
    some.refusedHere[1] = 8;
    some.refused[0] = 7;
    some.refused.back() = 5;
    master::IncidentFile(folder, false).keep(some, kSecond);
    EXPECT_EQ(master::IncidentFile(folder, true).before(), some);
    const master::IncidentFile anew(folder, false);
    EXPECT_EQ(anew.before(), master::Incidents{});
    EXPECT_TRUE(written()) << "it may be a running session's, which this one is refused beside";
    anew.forget();
    EXPECT_FALSE(written());
}

TEST_F(IncidentFileTest, IsWrittenWhenSomethingWasAddedAndNotForEveryFrame) {
    master::IncidentFile file(folder, false);
    file.keep({}, kSecond);
    EXPECT_FALSE(written()) << "nothing has happened";
    file.keep({.healed = 1}, kSecond);
    EXPECT_TRUE(written());
    file.keep({.healed = 2}, kSecond + kSecond / 8);
    EXPECT_EQ(master::IncidentFile(folder, true).before().healed, 1U) << "too soon";
    file.keep({.healed = 2}, kSecond + kSecond / 2);
    EXPECT_EQ(master::IncidentFile(folder, true).before().healed, 2U);
}

TEST_F(IncidentFileTest, IsWrittenWhenTheDiskLetsItAndAtTheEnd) {
    master::IncidentFile file(folder, false);
    std::filesystem::remove_all(folder);  // as good as a full disk
    file.keep({.stands = 1}, kSecond);
    std::filesystem::create_directories(folder);
    file.keep({.stands = 1}, 2 * kSecond);
    EXPECT_EQ(master::IncidentFile(folder, true).before().stands, 1U);
    file.keep({.stands = 2}, 2 * kSecond + 1);
    file.keepLast({.stands = 2});
    EXPECT_EQ(master::IncidentFile(folder, true).before().stands, 2U);
}

TEST_F(IncidentFileTest, CountsFromHereOnWhenItIsDamaged) {
    for (const char* text : {"", "{\"healed\":", "{\"healed\":1}", "[]", "{\"divergences\":-\"x\"}"}) {
        std::ofstream(folder / "incidents.json") << text;
        testing::internal::CaptureStderr();
        const master::IncidentFile file(folder, true);
        EXPECT_NE(testing::internal::GetCapturedStderr().find("incidents.json: "), std::string::npos) << text;
        EXPECT_EQ(file.before(), master::Incidents{}) << text;
    }
}

}  // namespace
