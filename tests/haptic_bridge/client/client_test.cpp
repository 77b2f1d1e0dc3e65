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
#include "tests/haptic_bridge/client/fake_server.hpp"
#include "tests/haptic_bridge/server/server_process.hpp"

namespace {

using namespace haptic_bridge;
using namespace test;

const Offer kOffer{42, "dunes"};
const Identity kIdentity{kProtocolVersion, sand::kAlgorithmVersion, 42, "dunes"};

bool reaches(const Client& client, Link link) {
    return eventually([&] { return client.link().link == link; });
}

StepMessage stepOf(std::uint32_t epoch, std::uint64_t number) {
    return {1, 2, {epoch, number, false, {{static_cast<std::int32_t>(number), 0, 0}}}};
}

/// Welcomes the client and takes over the numbering of steps.
bool linkUp(FakeServer::Guest& guest) {
    if (!guest.await<Hello>()) {
        return false;
    }
    guest.send(Welcome{kIdentity, 60});
    if (!guest.await<Start>()) {
        return false;
    }
    guest.send(Ready{});
    return true;
}

void grantWhenOffered(Client& client, std::uint32_t epoch, std::uint64_t number) {
    ASSERT_TRUE(reaches(client, Link::offered)) << client.link().message;
    client.grant(epoch, number, 0, {});
}

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
    FakeServer server([](FakeServer::Guest& guest) { guest.await<Bye>(); });
    Client client(server.address(), kOffer);
    ASSERT_TRUE(eventually([&] { return server.guests() == 1; }));
    client.stop();
}

// TLS is not established yet, so the client cannot send a goodbye.
TEST(Client, StopsWhileAServerStaysSilentBeforeTls) {
    FakeServer server([](FakeServer::Guest& guest) {
        std::array<std::uint8_t, 4096> chunk{};
        while (recv(guest.socket, chunk.data(), chunk.size(), 0) > 0) {
        }
    });
    LinkSecurity security;
    security.functions = &loadSecurity("test");
    security.secrets.move = "0123456789abcdef";
    security.tls = security.functions->tlsClient();
    Client client(server.address(), kOffer, security);
    ASSERT_TRUE(eventually([&] { return server.guests() == 1; }));
    client.stop();
    EXPECT_EQ(client.link().link, Link::stopped);
}

TEST(Client, CountsByKindHowOftenItWasRefused) {
    FakeServer server(toTheFirst([](FakeServer::Guest& guest) {
        guest.await<Hello>();
        guest.send(Refusal{RefusalCode::busy, "another wall is linked"});
        guest.await<Bye>();
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
        FakeServer server([&](FakeServer::Guest& guest) {
            guest.await<Hello>();
            guest.send(Welcome{other, 60});
            guest.await<Bye>();
        });
        const Client client(server.address(), kOffer);
        ASSERT_TRUE(reaches(client, Link::refused)) << client.link().message;
        const std::array<const char*, 3> words{"protocol version", "algorithm version", "material"};
        EXPECT_NE(client.link().message.find(words[static_cast<std::size_t>(which)]), std::string::npos)
            << client.link().message;
    }
}

TEST(Client, RefusesGarbageAndTriesAgain) {
    FakeServer server([](FakeServer::Guest& guest) {
        const std::string banner = "SSH-2.0-OpenSSH_9.2\r\n";
        guest.send({reinterpret_cast<const std::uint8_t*>(banner.data()), banner.size()});
        guest.await<Bye>();
    });
    const Client client(server.address(), kOffer);
    ASSERT_TRUE(reaches(client, Link::refused));
    EXPECT_NE(client.link().message.find("it sent a message of"), std::string::npos) << client.link().message;
    EXPECT_TRUE(eventually([&] { return server.guests() >= 2; })) << "the client must try again";
}

TEST(Client, TakesPositionsFromAServerWithoutSand) {
    FakeServer server(toTheFirst([](FakeServer::Guest& guest) {
        guest.send(PositionGreeting{kProtocolVersion, "glove"});  // sent without reading the Hello
        for (int i = 0; i < 3; ++i) {
            guest.send(Position{i, 0.1 * i, 0, 0, true});
        }
        guest.await<Bye>();
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
    FakeServer server([](FakeServer::Guest& guest) {
        guest.send(PositionGreeting{kProtocolVersion, "hose"});
        const base::Bytes many = positions(1000);
        for (int i = 0; i < 400; ++i) {
            guest.send(std::span<const std::uint8_t>(many));
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
    FakeServer server([&](FakeServer::Guest& guest) {
        if (!guest.await<Hello>()) {
            return;
        }
        const auto welcomed = std::chrono::steady_clock::now();
        guest.send(Welcome{kIdentity, 60});
        guest.await<Start>();
        std::this_thread::sleep_until(welcomed + 470ms);
        guest.send(NeedState{});
        needed = true;
        eventually([&] { return over.load(); });  // reads no more messages
    });
    Client client(server.address(), kOffer);
    ASSERT_TRUE(reaches(client, Link::offered)) << client.link().message;
    client.grant(1, 10, 0, base::Bytes(std::size_t{256} << 20U), {});
    ASSERT_TRUE(eventually([&] { return needed.load(); }));
    std::this_thread::sleep_for(10ms);
    // The server reads no more messages until `over` is set. A stop that waited for the server would not return.
    const auto stopped = std::async(std::launch::async, [&] { client.stop(); });
    EXPECT_EQ(stopped.wait_for(60s), std::future_status::ready);
    over = true;
}

TEST(Client, RefusesPositionsOfAnotherVersionOrOutOfTurn) {
    FakeServer other([](FakeServer::Guest& guest) {
        guest.send(PositionGreeting{kProtocolVersion + 1, "glove"});
        guest.await<Bye>();
    });
    const Client client(other.address(), kOffer);
    ASSERT_TRUE(reaches(client, Link::refused));
    EXPECT_NE(client.link().message.find("protocol version"), std::string::npos) << client.link().message;
    FakeServer turncoat(toTheFirst([](FakeServer::Guest& guest) {
        if (linkUp(guest)) {
            guest.send(PositionGreeting{kProtocolVersion, "glove"});
            guest.await<Bye>();
        }
    }));
    Client linked(turncoat.address(), kOffer);
    grantWhenOffered(linked, 1, 10);
    ASSERT_TRUE(eventually([&] { return linked.link().message.find("out of turn") != std::string::npos; }));
}

TEST(Client, KeepsTheStepsBeforeHalfAMessage) {
    FakeServer server(toTheFirst([](FakeServer::Guest& guest) {
        if (linkUp(guest)) {
            guest.send(stepOf(1, 11));
            guest.send(stepOf(1, 12));
            guest.send(std::span<const std::uint8_t>(encode(stepOf(1, 13))).first(9));
        }
    }));
    Client client(server.address(), kOffer);
    grantWhenOffered(client, 1, 10);
    ASSERT_TRUE(eventually([&] { return client.link().message.find("middle of a message") != std::string::npos; }))
        << client.link().message;
    const auto steps = client.drain(10);
    ASSERT_EQ(steps.size(), 2U);
    EXPECT_EQ(steps[1].step.number, 12U);
}

TEST(Client, LeavesOutLateDoubledAndForeignSteps) {
    FakeServer server([](FakeServer::Guest& guest) {
        if (linkUp(guest)) {
            for (const auto& [epoch, number] : std::vector<std::pair<std::uint32_t, std::uint64_t>>{
                     {4, 8}, {4, 8}, {3, 9}, {4, 7}, {4, 9}, {5, 10}, {4, 10}}) {
                guest.send(stepOf(epoch, number));
            }
            guest.await<Bye>();
        }
    });
    Client client(server.address(), kOffer);
    grantWhenOffered(client, 4, 7);
    ASSERT_TRUE(eventually([&] { return client.counters().stepsIn == 3; }));
    const auto steps = client.drain(100);
    ASSERT_EQ(steps.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(steps[i].step.number, 8 + i);
        EXPECT_EQ(steps[i].step.epoch, 4U);
        EXPECT_GT(steps[i].receivedNs, 0);
    }
    EXPECT_EQ(client.counters().stepsStale, 2U);
    EXPECT_EQ(client.counters().stepsForeign, 2U);
    EXPECT_EQ(client.link().link, Link::linked);
}

TEST(Client, GivesUpTheLinkOverAMissingStep) {
    std::atomic<bool> seen = false;
    FakeServer server([&](FakeServer::Guest& guest) {
        if (server.guests() > 1) {
            eventually([&] { return seen.load(); });  // a greeting would replace the message
        }
        if (linkUp(guest)) {
            guest.send(stepOf(1, 1));
            guest.send(stepOf(1, 3));
            guest.await<Bye>();
        }
    });
    Client client(server.address(), kOffer);
    grantWhenOffered(client, 1, 0);
    ASSERT_TRUE(eventually([&] { return client.link().message.find("step 3 came after step 1") != std::string::npos; }))
        << client.link().message;
    seen = true;
    EXPECT_EQ(client.drain(10).size(), 1U);
    EXPECT_TRUE(reaches(client, Link::offered)) << "the client must connect again";
}

StepMessage editOf(std::uint64_t number, const sand::Edit& edit) {
    StepMessage message = stepOf(1, number);
    message.step.edit = edit;
    return message;
}

// Without this, a server could fill memory and journal with sand that no operator has loaded.
TEST(Client, EndsTheLinkOverAnEditThatItHasNotAskedFor) {
    const std::array<sand::Edit, 2> edits{sand::Edit::loaded(base::Bytes(60'000, 7)), sand::Edit(sand::Edit::settle)};
    for (const sand::Edit& edit : edits) {
        FakeServer server(toTheFirst([&](FakeServer::Guest& guest) {
            if (linkUp(guest)) {
                guest.send(stepOf(1, 1));
                guest.send(editOf(2, edit));
                guest.await<Bye>();
            }
        }));
        Client client(server.address(), kOffer);
        grantWhenOffered(client, 1, 0);
        const auto refused = [&] {
            return client.counters().refused[static_cast<std::size_t>(RefusalCode::garbage) - 1];
        };
        EXPECT_TRUE(eventually([&] { return refused() == 1; }, 10000ms));
        const auto steps = client.drain(10);
        ASSERT_EQ(steps.size(), 1U);
        EXPECT_FALSE(steps[0].step.edit.any());
    }
}

TEST(Client, TakesALongLoadOnceForEachThatItAskedFor) {
    const sand::Edit load = sand::Edit::loaded(base::Bytes(1'000'000, 7));
    FakeServer server(toTheFirst([&](FakeServer::Guest& guest) {
        guest.reader.expectLoads(true);
        if (linkUp(guest) && guest.await<EditRequest>()) {
            guest.send(editOf(1, load));
            guest.send(editOf(2, load));
            guest.await<Bye>();
        }
    }));
    Client client(server.address(), kOffer);
    grantWhenOffered(client, 1, 0);
    ASSERT_TRUE(reaches(client, Link::linked)) << client.link().message;
    client.request(load);
    const auto refused = [&] { return client.counters().refused[static_cast<std::size_t>(RefusalCode::garbage) - 1]; };
    EXPECT_TRUE(eventually([&] { return refused() == 1; }, 10000ms));
    const auto steps = client.drain(10);
    ASSERT_EQ(steps.size(), 1U);
    EXPECT_EQ(steps[0].step.edit, load);
}

TEST(Client, AnswersATimingTestAtOnceAndAgainWhenAFrameThatTookItIsShown) {
    std::atomic<bool> received = false;
    std::atomic<int> framesBefore = -1;
    FakeServer server([&](FakeServer::Guest& guest) {
        if (!linkUp(guest)) {
            return;
        }
        guest.send(stepOf(1, 1));
        guest.send(stepOf(1, 2));
        guest.send(TimingTest{5, 40});
        guest.send(stepOf(1, 3));
        received = guest.await<TimingEcho>() == TimingEcho{5, Leg::received};
        for (int frames = 0; const auto message = guest.next();) {
            frames += std::holds_alternative<Shown>(*message) ? 1 : 0;
            if (*message == Message(TimingEcho{5, Leg::shown})) {
                framesBefore = frames;
                break;
            }
        }
        guest.await<Bye>();
    });
    Client client(server.address(), kOffer);
    grantWhenOffered(client, 1, 0);
    ASSERT_TRUE(eventually([&] { return client.counters().stepsIn == 3; }));
    EXPECT_TRUE(eventually([&] { return received.load(); })) << "the first echo comes before any frame";
    client.shown(0, 1);  // this frame began before the test came
    EXPECT_EQ(client.drain(1).size(), 1U);
    client.shown(1, 1);  // this frame took only a part of the steps before the test
    EXPECT_EQ(client.drain(1).size(), 1U);
    client.shown(2, 1);  // this frame took all steps before the test
    client.shown(3, 1);
    EXPECT_TRUE(eventually([&] { return framesBefore >= 0; }));
    EXPECT_EQ(framesBefore, 3);
}

TEST(Client, HoldsAFloodBackAndLosesNothing) {
    constexpr std::uint64_t kSteps = 5000;
    FakeServer server([](FakeServer::Guest& guest) {
        if (linkUp(guest)) {
            for (std::uint64_t number = 1; number <= kSteps; ++number) {
                guest.send(stepOf(1, number));
            }
            guest.await<Bye>();
        }
    });
    Client client(server.address(), kOffer);
    grantWhenOffered(client, 1, 0);
    ASSERT_TRUE(eventually([&] { return client.counters().stepsIn == Client::kMaxQueued; }));
    std::this_thread::sleep_for(50ms);
    EXPECT_EQ(client.counters().stepsIn, Client::kMaxQueued) << "no caller drains the steps";
    std::uint64_t next = 1;
    ASSERT_TRUE(eventually([&] {
        for (const auto& timed : client.drain(100)) {
            EXPECT_EQ(timed.step.number, next++);
        }
        return next == kSteps + 1;
    }));
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
