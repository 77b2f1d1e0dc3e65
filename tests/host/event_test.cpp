// SPDX-License-Identifier: Apache-2.0
#include "host/event.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/support/processes/events.hpp"

namespace {

using nlohmann::json;

TEST(Event, IsOneTaggedLineOfJsonWithItsFieldsInOrder) {
    EXPECT_EQ(host::eventLine("drill", {{"frame", 30U}, {"fault", "die:rank=2"}, {"late", true}, {"seconds", 1.5}}),
              R"(@sandwall {"event":"drill","frame":30,"fault":"die:rank=2","late":true,"seconds":1.5})");
}

TEST(Event, KeepsTextOnOneLineAndReplacesWhatIsNotUtf8) {
    EXPECT_EQ(host::eventLine("journal", {{"error", "two\nlines \"quoted\" \xff"}}),
              "@sandwall {\"event\":\"journal\",\"error\":\"two\\nlines \\\"quoted\\\" \xef\xbf\xbd\"}");
}

TEST(Event, TakesJsonAsItIsAndRefusesWhatIsNoJson) {
    EXPECT_EQ(host::eventLine("waiting", {{"ranks", host::Json{"[2,3]"}}}),
              R"(@sandwall {"event":"waiting","ranks":[2,3]})");
    EXPECT_THROW((void)host::eventLine("waiting", {{"ranks", host::Json{"[2,"}}}), std::invalid_argument);
}

// A program without SANDWALL_EVENTS prints only its messages. Each process reads the variable once, so each case runs
// in a process of its own.
TEST(Event, IsWrittenOnlyWhereItIsWanted) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const auto emitWith = [](const char* value) {
        setenv("SANDWALL_EVENTS", value, 1);
        host::emitEvent("stopping");
        std::_Exit(7);
    };
    EXPECT_EXIT(emitWith("1"), testing::ExitedWithCode(7), "^@sandwall \\{\"event\":\"stopping\"\\}\n$");
    EXPECT_EXIT(emitWith("0"), testing::ExitedWithCode(7), "^$");
}

TEST(EventsOfTests, AreFoundAmongMessagesAndComparedByTheFieldsThatAreWanted) {
    const std::string output =
        "a message\n@sandwall {\"event\":\"link\",\"epoch\":3,\"at\":{\"x\":1,\"y\":2}}\n@sandwall "
        "{\"event\":\"drill\"}\n"
        "@sandwall {\"event\":\"link\",\"epoch\":4";
    const auto links = support::eventsIn(output, "link");
    ASSERT_EQ(links.size(), 1U) << "an unfinished line must not count as an event";
    EXPECT_EQ(support::eventsIn(output).size(), 2U);
    EXPECT_TRUE(support::holds(links[0], {{"epoch", 3}, {"at", {{"y", 2}}}}));
    EXPECT_FALSE(support::holds(links[0], {{"epoch", 4}}));
    EXPECT_FALSE(support::holds(links[0], {{"at", {{"z", 2}}}}));
    EXPECT_EQ(support::messagesIn(output), "a message\n");
}

}  // namespace
