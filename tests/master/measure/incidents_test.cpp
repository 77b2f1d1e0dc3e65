// SPDX-License-Identifier: Apache-2.0
#include "master/measure/incidents.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/support/files/folder_test.hpp"

namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

class IncidentFileTest : public test::FolderTest {
protected:
    [[nodiscard]] bool written() const { return std::filesystem::exists(folder_ / "incidents.json"); }
};

TEST_F(IncidentFileTest, IsReadByTheTryThatGoesOnAndByNoSessionThatBeginsAnew) {
    master::Incidents some{.divergences = 3,
                           .healed = 2,
                           .outvoted = 1,
                           .serverDivergences = 1,
                           .stepsLeftOut = 9,
                           .stepsUnplaced = 10,
                           .links = 6,
                           .reconnects = 4,
                           .stops = 1,
                           .firstDifference = 250};
    some.refusedHere[1] = 8;
    some.refused[0] = 7;
    some.refused.back() = 5;
    master::IncidentFile(folder_, false).keep(some, kSecond);
    EXPECT_EQ(master::IncidentFile(folder_, true).before(), some);
    const master::IncidentFile anew(folder_, false);
    EXPECT_EQ(anew.before(), master::Incidents{});
    EXPECT_TRUE(written()) << "the file may belong to a running session, beside which this one is refused";
    anew.forget();
    EXPECT_FALSE(written());
}

TEST_F(IncidentFileTest, IsWrittenWhenSomethingWasAddedAndNotForEveryFrame) {
    master::IncidentFile file(folder_, false);
    file.keep({}, kSecond);
    EXPECT_FALSE(written()) << "nothing has happened";
    file.keep({.healed = 1}, kSecond);
    EXPECT_TRUE(written());
    file.keep({.healed = 2}, kSecond + kSecond / 8);
    EXPECT_EQ(master::IncidentFile(folder_, true).before().healed, 1U) << "too soon";
    file.keep({.healed = 2}, kSecond + kSecond / 2);
    EXPECT_EQ(master::IncidentFile(folder_, true).before().healed, 2U);
}

TEST_F(IncidentFileTest, IsWrittenWhenTheDiskLetsItAndAtTheEnd) {
    master::IncidentFile file(folder_, false);
    std::filesystem::remove_all(folder_);  // acts like a full disk
    testing::internal::CaptureStderr();
    file.keep({.stops = 1}, kSecond);
    EXPECT_NE(testing::internal::GetCapturedStderr().find("incidents.json: cannot be written"), std::string::npos);
    testing::internal::CaptureStderr();
    file.keep({.stops = 1}, kSecond * 3 / 2);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "it was told already";
    std::filesystem::create_directories(folder_);
    file.keep({.stops = 1}, 2 * kSecond);
    EXPECT_EQ(master::IncidentFile(folder_, true).before().stops, 1U);
    file.keep({.stops = 2}, 2 * kSecond + 1);
    file.keepLast({.stops = 2});
    EXPECT_EQ(master::IncidentFile(folder_, true).before().stops, 2U);
}

TEST_F(IncidentFileTest, BelievesNoNumberThatIsNoCount) {
    master::IncidentFile(folder_, false).keep({.healed = 2, .links = 6}, kSecond);
    std::string text;
    std::getline(std::ifstream(folder_ / "incidents.json"), text);
    const auto counts = [&](const std::string& links) {
        std::string changed = text;
        changed.replace(changed.find("\"links\":6"), 9, "\"links\":" + links);
        std::ofstream(folder_ / "incidents.json") << changed;
        testing::internal::CaptureStderr();
        const master::IncidentFile file(folder_, true);
        const std::string said = testing::internal::GetCapturedStderr();
        const bool refused = said.find("incidents.json: links must be a whole number from 0 to 1000000000000, got " +
                                       links.substr(0, 40)) != std::string::npos;
        EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), refused ? 1 : 0) << said;
        EXPECT_EQ(file.before(), refused ? master::Incidents{} : (master::Incidents{.healed = 2, .links = 6})) << links;
        return !refused;
    };
    EXPECT_TRUE(counts("6"));
    for (const char* links : {"-3", "2.5", "1000000000001", "18446744073709551615", "\"6\"", "null", "[1]"}) {
        EXPECT_FALSE(counts(links)) << links;
    }
    EXPECT_FALSE(counts("\"" + std::string(5000, 'x') + "\"")) << "a long value is cut off";
}

TEST_F(IncidentFileTest, CountsFromHereOnWhenItIsDamaged) {
    for (const char* text : {"", "{\"healed\":", "{\"healed\":1}", "[]", "{\"divergences\":-\"x\"}"}) {
        std::ofstream(folder_ / "incidents.json") << text;
        testing::internal::CaptureStderr();
        const master::IncidentFile file(folder_, true);
        EXPECT_NE(testing::internal::GetCapturedStderr().find("incidents.json: "), std::string::npos) << text;
        EXPECT_EQ(file.before(), master::Incidents{}) << text;
    }
}

}  // namespace
