// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/server/roster.hpp"

#include <gtest/gtest.h>

#include <string>

namespace {

using namespace haptic_bridge;

/// A connection without a socket. It leaves the roster when it is asked to make room.
struct Someone {
    Roster<Someone>* roster = nullptr;
    std::string from = "192.0.2.1";
    std::weak_ptr<Someone> self;
    bool left = false;

    [[nodiscard]] boost::asio::ip::address address() const { return boost::asio::ip::make_address(from); }
    void makeRoom() {
        left = true;
        (void)roster->remove(self.lock());
    }
};

std::shared_ptr<Someone> comeTo(Roster<Someone>& roster, const std::string& from) {
    auto one = std::make_shared<Someone>();
    one->roster = &roster;
    one->from = from;
    one->self = one;
    roster.add(one);
    return one;
}

TEST(Roster, TheOldestUnauthenticatedConnectionMakesRoom) {
    Roster<Someone> roster;
    const auto first = comeTo(roster, "127.0.0.1"), second = comeTo(roster, "127.0.0.1");
    for (std::size_t i = 2; i < kMaxUnauthenticated; ++i) {
        (void)comeTo(roster, "127.0.0.1");
    }
    EXPECT_FALSE(first->left);
    EXPECT_TRUE(roster.hasRoomFor(second->address())) << "this machine may have any number of connections";
    (void)comeTo(roster, "127.0.0.1");
    EXPECT_TRUE(first->left);
    EXPECT_FALSE(second->left);
    EXPECT_EQ(roster.unauthenticated().size(), kMaxUnauthenticated);
}

TEST(Roster, OneAddressHasFourUnauthenticatedConnections) {
    Roster<Someone> roster;
    std::vector<std::shared_ptr<Someone>> connections;
    for (int i = 0; i < kMaxUnauthenticatedOfOne; ++i) {
        EXPECT_TRUE(roster.hasRoomFor(boost::asio::ip::make_address("192.0.2.1")));
        connections.push_back(comeTo(roster, "192.0.2.1"));
    }
    EXPECT_FALSE(roster.hasRoomFor(boost::asio::ip::make_address("192.0.2.1")));
    EXPECT_TRUE(roster.hasRoomFor(boost::asio::ip::make_address("192.0.2.2")));
    (void)roster.promoteToMaster(connections[0]);
    EXPECT_TRUE(roster.hasRoomFor(boost::asio::ip::make_address("192.0.2.1")))
        << "a welcomed peer does not count as an unauthenticated connection";
}

TEST(Roster, HasOneMasterAtATimeAndNumbersTheirSessions) {
    Roster<Someone> roster;
    const auto master = comeTo(roster, "127.0.0.1"), watcher = comeTo(roster, "127.0.0.1");
    EXPECT_EQ(roster.master(), nullptr);
    EXPECT_EQ(roster.promoteToMaster(master), 1U);
    roster.promoteToWatcher(watcher);
    EXPECT_EQ(roster.master(), master);
    EXPECT_EQ(roster.watchers(), std::vector{watcher});
    EXPECT_TRUE(roster.unauthenticated().empty());
    EXPECT_FALSE(roster.remove(watcher));
    EXPECT_EQ(roster.master(), master) << "a watcher that leaves does not remove the master";
    EXPECT_TRUE(roster.remove(master));
    EXPECT_EQ(roster.master(), nullptr);
    EXPECT_EQ(roster.promoteToMaster(comeTo(roster, "127.0.0.1")), 2U);
}

TEST(Roster, CountsConnectionsUntilTheyAreGone) {
    Roster<Someone> roster;
    std::vector<std::shared_ptr<int>> connections;
    for (int i = 0; i < kMaxConnections; ++i) {
        EXPECT_TRUE(roster.hasRoomFor(boost::asio::ip::make_address("127.0.0.1")));
        connections.push_back(roster.counted(std::make_unique<int>(i)));
    }
    EXPECT_FALSE(roster.hasRoomFor(boost::asio::ip::make_address("127.0.0.1")));
    connections.pop_back();
    EXPECT_EQ(roster.connections(), kMaxConnections - 1);
    EXPECT_TRUE(roster.hasRoomFor(boost::asio::ip::make_address("127.0.0.1")));
}

}  // namespace
