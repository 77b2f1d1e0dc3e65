// SPDX-License-Identifier: Apache-2.0
// The master's end of the link against faulty servers.
#include "haptic_bridge/client/client.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <future>
#include <thread>

#include "base/input_error.hpp"
#include "tests/haptic_bridge/client/linked_client.hpp"

namespace {

using namespace haptic_bridge;
using namespace test;

base::Bytes positions(int count) {
    base::Bytes many;
    for (int i = 0; i < count; ++i) {
        const base::Bytes one = encode(Position{i, 0, 0, 0, false});
        many.insert(many.end(), one.begin(), one.end());
    }
    return many;
}

TEST(Client, SaysThatNobodyAnswersAndStopsAtOnce) {
    Client client({"127.0.0.1", 1}, kOffer);
    ASSERT_TRUE(eventually([&] { return client.link().message.find("does not answer") != std::string::npos; }));
    EXPECT_EQ(client.link().link, Link::connecting);
    client.stop();
    client.stop();
    EXPECT_EQ(client.link().link, Link::stopped);
}

TEST(Client, StopsWhileAServerStaysSilent) {
    FakeServer server([](FakeServer::Connection& connection) { connection.await<Bye>(); });
    Client client(server.address(), kOffer);
    ASSERT_TRUE(eventually([&] { return server.connections() == 1; }));
    client.stop();
}

// TLS is not established yet, so the client cannot send a goodbye.
TEST(Client, StopsWhileAServerStaysSilentBeforeTls) {
    FakeServer server([](FakeServer::Connection& connection) {
        std::array<std::uint8_t, 4096> chunk{};
        while (recv(connection.socket, chunk.data(), chunk.size(), 0) > 0) {
        }
    });
    LinkSecurity security;
    security.functions = &loadSecurity("test");
    security.secrets.move = "0123456789abcdef";
    security.tls = security.functions->tlsClient();
    Client client(server.address(), kOffer, security);
    ASSERT_TRUE(eventually([&] { return server.connections() == 1; }));
    client.stop();
    EXPECT_EQ(client.link().link, Link::stopped);
}

TEST(Client, CountsByKindHowOftenItWasRefused) {
    FakeServer server(toTheFirst([](FakeServer::Connection& connection) {
        connection.await<Hello>();
        connection.send(Refusal{RefusalCode::busy, "another wall is linked"});
        connection.await<Bye>();
    }));
    const Client client(server.address(), kOffer);
    ASSERT_TRUE(reaches(client, Link::refused)) << client.link().message;
    RefusalCounts once{};
    once[static_cast<std::size_t>(RefusalCode::busy) - 1] = 1;
    EXPECT_EQ(client.counters().refusedHere, once);
    EXPECT_EQ(client.counters().refused, RefusalCounts{});
    EXPECT_EQ(client.counters().links, 0U);
}

TEST(Client, RefusesAServerOfAnotherVersionOrScene) {
    for (int which = 0; which < 3; ++which) {
        Identity other = kIdentity;
        other.protocol += which == 0 ? 1 : 0;
        other.algorithm += which == 1 ? 1 : 0;
        other.rulesDigest += which == 2 ? 1 : 0;
        FakeServer server([&](FakeServer::Connection& connection) {
            connection.await<Hello>();
            connection.send(Welcome{other, 60});
            connection.await<Bye>();
        });
        const Client client(server.address(), kOffer);
        ASSERT_TRUE(reaches(client, Link::refused)) << client.link().message;
        const std::array<const char*, 3> words{"protocol version", "algorithm version", "material"};
        EXPECT_NE(client.link().message.find(words[static_cast<std::size_t>(which)]), std::string::npos)
            << client.link().message;
    }
}

TEST(Client, RefusesGarbageAndTriesAgain) {
    FakeServer server([](FakeServer::Connection& connection) {
        const std::string banner = "SSH-2.0-OpenSSH_9.2\r\n";
        connection.send({reinterpret_cast<const std::uint8_t*>(banner.data()), banner.size()});
        connection.await<Bye>();
    });
    const Client client(server.address(), kOffer);
    ASSERT_TRUE(reaches(client, Link::refused));
    EXPECT_NE(client.link().message.find("it sent a message of"), std::string::npos) << client.link().message;
    EXPECT_TRUE(eventually([&] { return server.connections() >= 2; })) << "the client must try again";
}

TEST(Client, TakesPositionsFromAServerWithoutSand) {
    FakeServer server(toTheFirst([](FakeServer::Connection& connection) {
        connection.send(PositionGreeting{kProtocolVersion, "glove"});  // sent without reading the Hello
        for (int i = 0; i < 3; ++i) {
            connection.send(Position{i, 0.1 * i, 0, 0, true});
        }
        connection.await<Bye>();
    }));
    Client client(server.address(), kOffer);
    ASSERT_TRUE(reaches(client, Link::streaming)) << client.link().message;
    EXPECT_NE(client.link().message.find("'glove' streams positions"), std::string::npos) << client.link().message;
    EXPECT_EQ(client.counters().links, 1U);
    std::vector<TimedPosition> got;
    ASSERT_TRUE(eventually([&] {
        for (const TimedPosition& position : client.drainPositions()) {
            got.push_back(position);
        }
        return got.size() == 3;
    }));
    EXPECT_EQ(got[2].position, (Position{2, 0.2, 0, 0, true}));
}

TEST(Client, HoldsAFloodOfPositionsBack) {
    FakeServer server([](FakeServer::Connection& connection) {
        connection.send(PositionGreeting{kProtocolVersion, "hose"});
        const base::Bytes many = positions(1000);
        for (int i = 0; i < 400; ++i) {
            connection.send(std::span<const std::uint8_t>(many));
        }
    });
    Client client(server.address(), kOffer);
    ASSERT_TRUE(eventually([&] { return client.floods() == 1; }));
    std::size_t most = 0, all = 0;
    ASSERT_TRUE(eventually([&] {
        const std::size_t count = client.drainPositions().size();
        most = std::max(most, count);
        all += count;
        return all >= 100'000;
    }));
    // The client still takes in the rest of a chunk of the socket beyond the bound.
    EXPECT_LE(most, Client::kMaxPositions + 64 * 1024 / 38);
}

TEST(Client, StopsThoughAnotherTimerBecomesDueMeanwhile) {
    // The client checks the link every half second. This check and the stop both become due while the network thread is
    // busy with a large state, the stop first. The check must not delay the end.
    std::atomic<bool> needed = false, over = false;
    FakeServer server([&](FakeServer::Connection& connection) {
        if (!connection.await<Hello>()) {
            return;
        }
        const auto welcomed = std::chrono::steady_clock::now();
        connection.send(Welcome{kIdentity, 60});
        connection.await<StartMessage>();
        std::this_thread::sleep_until(welcomed + 470ms);
        connection.send(NeedState{});
        needed = true;
        eventually([&] { return over.load(); });  // reads no more messages
    });
    Client client(server.address(), kOffer);
    ASSERT_TRUE(reaches(client, Link::offered)) << client.link().message;
    client.grant(1, 10, 0);
    ASSERT_TRUE(eventually([&] { return needed.load() && client.needsState(); }));
    client.giveState(base::Bytes(std::size_t{256} << 20U));
    std::this_thread::sleep_for(10ms);
    // The server reads no more messages until `over` is set. A stop that waited for the server would not return.
    const auto stopped = std::async(std::launch::async, [&] { client.stop(); });
    EXPECT_EQ(stopped.wait_for(60s), std::future_status::ready);
    over = true;
}

TEST(Client, RefusesPositionsOfAnotherVersionOrOutOfTurn) {
    FakeServer other([](FakeServer::Connection& connection) {
        connection.send(PositionGreeting{kProtocolVersion + 1, "glove"});
        connection.await<Bye>();
    });
    const Client client(other.address(), kOffer);
    ASSERT_TRUE(reaches(client, Link::refused));
    EXPECT_NE(client.link().message.find("protocol version"), std::string::npos) << client.link().message;
    FakeServer turncoat(toTheFirst([](FakeServer::Connection& connection) {
        if (linkUp(connection)) {
            connection.send(PositionGreeting{kProtocolVersion, "glove"});
            connection.await<Bye>();
        }
    }));
    Client linked(turncoat.address(), kOffer);
    grantWhenOffered(linked, 1, 10);
    ASSERT_TRUE(eventually([&] { return linked.link().message.find("out of turn") != std::string::npos; }));
}

TEST(Client, ReadsAddressesAndNamesWhatIsWrong) {
    EXPECT_EQ(Address::parse("node3:99", "--haptic").port, 99);
    EXPECT_EQ(Address::parse("node3", "--haptic").port, kDefaultPort);
    EXPECT_EQ(Address::parse("[::1]:80", "--haptic").host, "::1");
    EXPECT_EQ(Address::parse("[::1]:80", "--haptic").text(), "[::1]:80");
    for (const char* wrong : {"", ":1", "a:70000", "a:", "a:1x", "[::1"}) {
        EXPECT_THROW((void)Address::parse(wrong, "--haptic"), base::InputError) << wrong;
    }
}

}  // namespace
