// SPDX-License-Identifier: Apache-2.0
// A master whose haptic server still reads its scene.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "tests/haptic_bridge/client/linked_client.hpp"

namespace {

using namespace haptic_bridge;
using namespace test;
using namespace std::chrono_literals;

/// Sends a Loading with `done` every few milliseconds, until the client has disconnected or `over` is set.
void keepLoading(FakeServer::Connection& connection, const std::atomic<std::uint32_t>& done,
                 const std::atomic<bool>& over) {
    if (!connection.await<Hello>()) {
        return;
    }
    while (!over && connection.send(std::span<const std::uint8_t>(encode(Loading{done})))) {
        std::this_thread::sleep_for(60ms);
    }
}

class LoadingServer : public testing::Test {
protected:
    ~LoadingServer() override { over_ = true; }
    std::atomic<std::uint32_t> done_ = 0;
    std::atomic<bool> over_ = false;
    std::atomic<std::int64_t> nowNs_ = 1'000'000'000;
    FakeServer server_{[this](FakeServer::Connection& connection) { keepLoading(connection, done_, over_); }};
    Client client_{server_.address(), kOffer, {}, [this] { return nowNs_.load(); }};
};

TEST_F(LoadingServer, CountsOnlyProgressOfAHundredth) {
    ASSERT_TRUE(reaches(client_, Link::loading)) << client_.link().message;
    const auto reads = [this](std::uint32_t done) {
        done_ = done;
        return eventually([&] { return client_.link().loaded == done; });
    };
    EXPECT_TRUE(reads(100));
    for (const std::uint32_t done : {109U, 40U, 0U}) {
        done_ = done;
        std::this_thread::sleep_for(150ms);
        EXPECT_EQ(client_.link().loaded, 100U) << done;
    }
    EXPECT_TRUE(reads(110));
    EXPECT_TRUE(reads(Loading::kAll));
    EXPECT_EQ(client_.counters().links, 0U);
}

TEST_F(LoadingServer, IsDroppedIfItGetsNoFurtherThoughItSpeaks) {
    ASSERT_TRUE(reaches(client_, Link::loading)) << client_.link().message;
    nowNs_ += kLoadingNs - 1'000'000'000;
    std::this_thread::sleep_for(1100ms);  // the link looks at its clock twice a second
    ASSERT_EQ(client_.link().link, Link::loading) << "longer than an ordinary silence";
    done_ = 500;
    ASSERT_TRUE(eventually([&] { return client_.link().loaded == 500; }));
    nowNs_ += kLoadingNs - 1'000'000'000;
    std::this_thread::sleep_for(1100ms);
    ASSERT_EQ(client_.link().link, Link::loading) << "it has got further";
    nowNs_ += 2'000'000'000;
    EXPECT_TRUE(eventually([&] { return client_.lastFailure() == "its scene gets no further for 120 s"; }))
        << client_.lastFailure();
}

TEST(Loading, LetsTheClientGreetAgainAtOnce) {
    std::atomic<int> greeted = 0;
    FakeServer server([&](FakeServer::Connection& connection) {
        if (connection.await<Hello>() && greeted++ == 0) {
            connection.send(Loading{Loading::kAll});
            connection.send(Bye{"its scene is read"});
        } else if (greeted == 2) {
            connection.send(Welcome{kIdentity, 60});
            connection.await<Bye>();
        }
    });
    const Client client(server.address(), kOffer);
    ASSERT_TRUE(reaches(client, Link::offered)) << client.link().message;
    EXPECT_EQ(greeted, 2);
    EXPECT_EQ(client.counters().reconnects, 0U);
}

TEST(Loading, AMillionMessagesDoNotKeepTheClientBusy) {
    FakeServer server([](FakeServer::Connection& connection) {
        if (!connection.await<Hello>()) {
            return;
        }
        base::Bytes many;
        for (int i = 0; i < 1000; ++i) {
            const base::Bytes one = encode(Loading{1});
            many.insert(many.end(), one.begin(), one.end());
        }
        for (int i = 0; i < 1000 && connection.send(std::span<const std::uint8_t>(many)); ++i) {
        }
    });
    Client client(server.address(), kOffer);
    ASSERT_TRUE(reaches(client, Link::loading)) << client.link().message;
    std::this_thread::sleep_for(200ms);
    EXPECT_LE(client.counters().bytesIn, 256U << 10U) << "TCP holds the server back";
    client.stop();
}

TEST(Loading, IsOutOfTurnOnALink) {
    FakeServer server(toTheFirst([](FakeServer::Connection& connection) {
        if (linkUp(connection)) {
            connection.send(Loading{1});
        }
    }));
    Client client(server.address(), kOffer);
    grantWhenOffered(client, 1, 10);
    EXPECT_TRUE(eventually([&] { return client.link().message.find("out of turn") != std::string::npos; }))
        << client.link().message;
}

}  // namespace
