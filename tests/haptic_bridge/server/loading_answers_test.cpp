// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/server/loading_answers.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "haptic_bridge/server/listen_at.hpp"
#include "tests/haptic_bridge/link/link_security_fixture.hpp"
#include "tests/haptic_bridge/link/raw_peer.hpp"

namespace {

using namespace haptic_bridge;
using namespace test;
using namespace std::chrono_literals;

namespace asio = boost::asio;

/// A server that reads its scene until end().
class LoadingAnswersTest : public LinkSecurityTest {
protected:
    void listen(const std::string& secret = "") {
        LinkOptions options;
        options.secretFile = secret;
        const LinkSecurity security = options.forServer();
        asio::ip::tcp::acceptor acceptor = listenAt(io_, "127.0.0.1:0", security.proves());
        port_ = acceptor.local_endpoint().port();
        answers_ = std::make_unique<LoadingAnswers>(io_, std::move(acceptor), security, [](const std::string&) {});
    }
    void TearDown() override {
        if (answers_ && !ended_) {
            (void)end();
        }
    }
    [[nodiscard]] Address address() const { return {"127.0.0.1", port_}; }
    /// Ends the loading, and runs what is left on the connections.
    asio::ip::tcp::acceptor end() {
        ended_ = true;
        asio::ip::tcp::acceptor acceptor = answers_->end();
        io_.run_for(10s);  // until all connections are closed
        return acceptor;
    }
    /// Returns so many peers, each of which has got a Loading.
    std::vector<std::unique_ptr<RawPeer>> peersThatWait(int count, Role role) {
        std::vector<std::unique_ptr<RawPeer>> peers;
        for (int i = 0; i < count; ++i) {
            peers.push_back(std::make_unique<RawPeer>(port_));
            peers.back()->send(hello(role));
            const auto answer = peers.back()->receive();
            EXPECT_TRUE(answer && std::holds_alternative<Loading>(*answer)) << i;
        }
        return peers;
    }
    static bool loads(const Client& client, std::uint32_t done) {
        return eventually([&] { return client.link().link == Link::loading && client.link().loaded == done; });
    }

    asio::io_context io_;
    std::uint16_t port_ = 0;
    std::unique_ptr<LoadingAnswers> answers_;
    bool ended_ = false;
};

TEST_F(LoadingAnswersTest, TellHowMuchIsReadAndNeverLess) {
    listen();
    answers_->setDone(0.25);
    const Client client(address(), offerOf(scene_));
    ASSERT_TRUE(loads(client, 250)) << client.link().message;
    answers_->setDone(0.1);
    RawPeer peer(port_);
    peer.send(hello());
    const auto answer = peer.receive();
    ASSERT_TRUE(answer && std::holds_alternative<Loading>(*answer));
    EXPECT_EQ(std::get<Loading>(*answer).done, 250U);
    answers_->setDone(0.5);
    ASSERT_TRUE(loads(client, 500)) << client.link().message;
    const asio::ip::tcp::acceptor acceptor = end();
    EXPECT_TRUE(acceptor.is_open());
    EXPECT_TRUE(eventually([&] { return client.link().loaded == Loading::kAll; }));
    EXPECT_TRUE(eventually([&] { return client.link().link != Link::loading; }));
    EXPECT_EQ(client.lastFailure(), "it says goodbye: its scene is read");
}

// The server does not know its scene yet, so another one is no reason to refuse a master.
TEST_F(LoadingAnswersTest, CompareOnlyVersions) {
    listen();
    RawPeer other(port_);
    Hello hello = this->hello();
    hello.master.sceneName = "another";
    hello.master.rulesDigest = 1;
    other.send(hello);
    const auto answer = other.receive();
    ASSERT_TRUE(answer && std::holds_alternative<Loading>(*answer));
    RawPeer newer(port_);
    hello.master.algorithm += 1;
    newer.send(hello);
    EXPECT_NE(newer.refusal().find("algorithm version"), std::string::npos);
}

TEST_F(LoadingAnswersTest, AskForTheSecretFirst) {
    listen(both_);
    RawPeer without(port_);
    without.send(hello());
    EXPECT_NE(without.refusal().find("asks for a secret"), std::string::npos);
    const Client client(address(), offerOf(scene_), this->client(both_));
    EXPECT_TRUE(eventually([&] { return client.link().link == Link::loading; })) << client.link().message;
    const std::string wrong = secretFile("wrong", "move " + quoted(kMove) + "-else\n");
    EXPECT_NE(refusalOf(address(), this->client(wrong)).find("the secret"), std::string::npos);
}

TEST_F(LoadingAnswersTest, RefuseAllOtherMessages) {
    listen();
    RawPeer peer(port_);
    peer.send(hello());
    ASSERT_TRUE(peer.receive());
    peer.send(Ping{5});
    auto answer = peer.receive();
    while (answer && std::holds_alternative<Loading>(*answer)) {
        answer = peer.receive();
    }
    ASSERT_TRUE(answer && std::holds_alternative<Pong>(*answer));
    peer.send(StartMessage{1, 0, 0});
    answer = peer.receive();
    while (answer && std::holds_alternative<Loading>(*answer)) {
        answer = peer.receive();
    }
    EXPECT_TRUE(answer && std::holds_alternative<Refusal>(*answer));
}

TEST_F(LoadingAnswersTest, OnlySoManyPeersMayWait) {
    listen();
    const auto waiting = peersThatWait(8, Role::move);  // docs/protocol.md
    RawPeer more(port_);
    more.send(hello());
    EXPECT_NE(more.refusal().find("busy"), std::string::npos);
}

// Otherwise watchers could keep the master out.
TEST_F(LoadingAnswersTest, HalfOfTheWaitingPeersMayBeWatchers) {
    listen();
    const auto waiting = peersThatWait(4, Role::watch);
    RawPeer watcher(port_);
    watcher.send(hello(Role::watch));
    EXPECT_NE(watcher.refusal().find("busy"), std::string::npos);
    const auto master = peersThatWait(1, Role::move);
}

TEST_F(LoadingAnswersTest, EndWithoutPeersAndWithTheObject) {
    listen();
    const asio::ip::tcp::acceptor acceptor = end();
    EXPECT_TRUE(acceptor.is_open());
    answers_.reset();
    listen();
    answers_.reset();  // as when the scene cannot be read
}

}  // namespace
