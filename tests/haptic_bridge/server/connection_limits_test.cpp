// SPDX-License-Identifier: Apache-2.0
// Limits on unauthenticated connections: their number, their rate, and how often a refusal is printed.
#include "haptic_bridge/server/connection_limits.hpp"

#include <memory>

#include "tests/haptic_bridge/link/link_security_fixture.hpp"
#include "tests/haptic_bridge/link/raw_peer.hpp"

namespace {

using namespace haptic_bridge;
using namespace test;

TEST_F(LinkSecurityTest, ManyConnectionsAtOnceDoNotTouchTheLink) {
    ServerProcess server(folder_, arguments({}));
    Client master(server.address(), offerOf(scene_));
    Wall wall(scene_);
    ASSERT_TRUE(wall.follow(master, 10));
    std::vector<std::unique_ptr<RawPeer>> connections;
    connections.reserve(60);
    for (int i = 0; i < 60; ++i) {
        connections.push_back(std::make_unique<RawPeer>(server.port()));
    }
    ASSERT_TRUE(wall.follow(master, 100)) << master.link().message;
    connections.clear();
    EXPECT_EQ(wall.divergences + wall.outOfOrder, 0);
    EXPECT_EQ(master.counters().reconnects, 0U);
    master.stop();
    ASSERT_TRUE(master.report());
    EXPECT_GT(master.report()->refused[static_cast<std::size_t>(RefusalCode::limit) - 1], 20U);
    Client next(server.address(), offerOf(scene_));
    EXPECT_TRUE(wall.follow(next, 120)) << next.link().message;
}

TEST(ConnectionLimits, HoldsBackWhoComesOftenAndNobodyElse) {
    ConnectionLimits limits;
    const auto often = boost::asio::ip::make_address("192.0.2.1"), other = boost::asio::ip::make_address("192.0.2.2");
    std::int64_t now = 1'000'000'000;
    int came = 0;
    for (int i = 0; i < 100; ++i) {
        came += limits.mayCome(often, now) ? 1 : 0;
    }
    EXPECT_EQ(came, 16);
    EXPECT_TRUE(limits.mayCome(other, now));
    now += 1'000'000'000;
    EXPECT_TRUE(limits.mayCome(often, now));
    for (int i = 0; i < 100; ++i) {
        limits.refused(often, now);
    }
    now += 1'900'000'000;
    EXPECT_FALSE(limits.mayCome(often, now)) << "a refused address must wait longer";
    now += 300'000'000;
    EXPECT_TRUE(limits.mayCome(often, now)) << "it may come again after about two seconds";
    for (unsigned i = 0; i < 5000; ++i) {  // more addresses than are counted separately
        (void)limits.mayCome(boost::asio::ip::address_v4(0x0a000000U + i), now);
    }
    EXPECT_TRUE(limits.mayCome(often, now + 10'000'000'000));
}

/// Returns one of many addresses.
boost::asio::ip::address stranger(unsigned number) { return boost::asio::ip::address_v4(0x0a000000U + number); }

TEST(ConnectionLimits, AFullTableForgetsOnlyWhoHasNoDebt) {
    ConnectionLimits limits;
    const auto debtor = boost::asio::ip::make_address("192.0.2.1");
    const auto connections = [&limits](const boost::asio::ip::address& address, std::int64_t now) {
        int came = 0;
        while (limits.mayCome(address, now)) {
            ++came;
        }
        return came;
    };
    for (int i = 0; i < 100; ++i) {
        limits.refused(debtor, 0);
    }
    for (unsigned i = 0; i + 1 < ConnectionLimits::kAddresses; ++i) {
        ASSERT_TRUE(limits.mayCome(stranger(i), 0));
    }
    // The table is full, and every address in it has connected. All further ones share one count.
    EXPECT_EQ(connections(stranger(5000), 0), 16);
    EXPECT_EQ(connections(stranger(5001), 0), 0);
    EXPECT_FALSE(limits.mayCome(debtor, 0)) << "in debt, as before";
    EXPECT_EQ(connections(stranger(0), 0), 15) << "it has connected once";

    // After a second the addresses that have connected once may come as often as new ones, so they are forgotten. Then
    // a further address is counted by itself. The debtor waits longer than that.
    constexpr std::int64_t kSecond = 1'000'000'000;
    EXPECT_EQ(connections(stranger(5002), kSecond), 16);
    EXPECT_EQ(connections(stranger(5003), kSecond), 16) << "not of the shared count";
    EXPECT_FALSE(limits.mayCome(debtor, kSecond));
    EXPECT_EQ(connections(stranger(0), kSecond), 8) << "it was empty, and eight came back in a second";
    EXPECT_EQ(connections(debtor, 5 * kSecond), 16);
}

TEST(ConnectionLimits, TakeANetworkOfIpv6ForOneAddress) {
    const auto of = [](const char* text) { return countedAddress(boost::asio::ip::make_address(text)).to_string(); };
    EXPECT_EQ(of("192.0.2.1"), "192.0.2.1");
    EXPECT_EQ(of("::ffff:192.0.2.1"), "192.0.2.1");
    EXPECT_EQ(of("2001:db8:1:2:3:4:5:6"), "2001:db8:1:2::");
    ConnectionLimits limits;
    int came = 0;
    for (int i = 0; i < 100; ++i) {
        came += limits.mayCome(boost::asio::ip::make_address("2001:db8::" + std::to_string(i)), 1) ? 1 : 0;
    }
    EXPECT_EQ(came, 16);
}

TEST(Gate, HoldsBackWhoDoesWrongAndNotWhoComesTooOften) {
    std::vector<std::string> lines;
    Gate gate([&lines](const std::string& line) { lines.push_back(line); });
    const auto busy = boost::asio::ip::make_address("192.0.2.1"), wrong = boost::asio::ip::make_address("192.0.2.2");
    for (int i = 0; i < 40; ++i) {
        gate.refused(RefusalCode::busy, busy, "a master is linked", 1);
        gate.refused(RefusalCode::garbage, wrong, "", 1);
    }
    EXPECT_TRUE(gate.mayCome(busy, 1));
    EXPECT_FALSE(gate.mayCome(wrong, 1));
    EXPECT_EQ(lines, std::vector<std::string>{"192.0.2.1: a master is linked"}) << "each line once, and no empty line";
    EXPECT_EQ(gate.counts()[static_cast<std::size_t>(RefusalCode::garbage) - 1], 40U);
}

TEST(RefusalLog, SaysItOnceAndCountsTheRest) {
    RefusalLog log;
    EXPECT_EQ(log.add(RefusalCode::secret, "a", "line", 0), "line");
    EXPECT_FALSE(log.add(RefusalCode::secret, "a", "line", 1));
    EXPECT_TRUE(log.add(RefusalCode::garbage, "a", "line", 1)) << "another kind";
    EXPECT_TRUE(log.add(RefusalCode::secret, "b", "line", 1)) << "another peer";
    EXPECT_NE(log.add(RefusalCode::secret, "a", "line", RefusalLog::kQuietNs)->find("1 more"), std::string::npos);
    EXPECT_EQ(log.counts()[static_cast<std::size_t>(RefusalCode::secret) - 1], 4U);
}

TEST(RefusalLog, AFullLogForgetsOnlyLinesOlderThanAMinute) {
    RefusalLog log;
    EXPECT_TRUE(log.add(RefusalCode::secret, "a", "line", 0));
    const auto lines = [&log](const std::string& peer, std::int64_t now) {
        std::size_t count = 0;
        for (int i = 0; i < 5000; ++i) {
            count += log.add(RefusalCode::garbage, peer + std::to_string(i), "line", now) ? 1 : 0;
        }
        return count;
    };
    // One line for each further peer that fits, and one for all others together.
    EXPECT_EQ(lines("b", 1), RefusalLog::kRemembered - 1 + 1);
    EXPECT_FALSE(log.add(RefusalCode::secret, "a", "line", RefusalLog::kQuietNs - 1)) << "its minute is not over";
    EXPECT_EQ(lines("b", RefusalLog::kQuietNs), 0U) << "nor is theirs";
    // Now all are older. Peers of another name take their places, and all that do not fit share a line as before.
    EXPECT_EQ(lines("c", RefusalLog::kQuietNs + 1), RefusalLog::kRemembered + 1);
    EXPECT_TRUE(log.add(RefusalCode::secret, "a", "line", RefusalLog::kQuietNs + 1)) << "its minute is over";
}

}  // namespace
