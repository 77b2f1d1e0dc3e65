// SPDX-License-Identifier: Apache-2.0
// Steps, edits and timing tests that the master's end of the link gets once it is linked.
#include <gtest/gtest.h>

#include <chrono>
#include <span>
#include <thread>
#include <utility>
#include <vector>

#include "tests/haptic_bridge/client/linked_client.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

using namespace haptic_bridge;
using namespace test;
using samples::withNumber;

TEST(Client, KeepsTheStepsBeforeHalfAMessage) {
    FakeServer server(toTheFirst([](FakeServer::Connection& connection) {
        if (linkUp(connection)) {
            connection.send(stepOf(1, 11));
            connection.send(stepOf(1, 12));
            connection.send(std::span<const std::uint8_t>(encode(stepOf(1, 13))).first(9));
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
    FakeServer server([](FakeServer::Connection& connection) {
        if (linkUp(connection)) {
            for (const auto& [epoch, number] : std::vector<std::pair<std::uint32_t, std::uint64_t>>{
                     {4, 8}, {4, 8}, {3, 9}, {4, 7}, {4, 9}, {5, 10}, {4, 10}}) {
                connection.send(stepOf(epoch, number));
            }
            connection.await<Bye>();
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
    FakeServer server([&](FakeServer::Connection& connection) {
        if (server.connections() > 1) {
            eventually([&] { return seen.load(); });  // a greeting would replace the message
        }
        if (linkUp(connection)) {
            connection.send(stepOf(1, 1));
            connection.send(stepOf(1, 3));
            connection.await<Bye>();
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

std::uint64_t refusedForGarbage(const Client& client) {
    return client.counters().refused[static_cast<std::size_t>(RefusalCode::garbage) - 1];
}

TEST(Client, RefusesSweepsThatNoStepHas) {
    haptic_bridge::Offer tin = kOffer;
    tin.limits.leastSweeps = tin.limits.mostSweeps = 0;
    for (const auto& [offer, sweeps] : {std::pair(kOffer, 0), {kOffer, sand::kMostSweeps + 1}, {tin, 1}}) {
        FakeServer server(
            toTheFirst([&, given = offer.limits.leastSweeps, wrong = sweeps](FakeServer::Connection& connection) {
                if (linkUp(connection)) {
                    for (const std::uint64_t number : {1U, 2U}) {
                        StepMessage message = stepOf(1, number);
                        message.step.sweeps = number == 1 ? given : wrong;
                        connection.send(message);
                    }
                    connection.await<Bye>();
                }
            }));
        Client client(server.address(), offer);
        grantWhenOffered(client, 1, 0);
        EXPECT_TRUE(eventually([&] { return refusedForGarbage(client) == 1; }, 10000ms)) << sweeps;
        EXPECT_NE(client.lastFailure().find(std::to_string(sweeps) + " sweeps"), std::string::npos)
            << client.lastFailure();
        EXPECT_EQ(client.drain(10).size(), 1U) << "the step before it counts";
    }
}

// A frame cannot divide a step. Such a path took a second, and every frame can have one.
TEST(Client, RefusesAPathThatTakesTooLong) {
    FakeServer server(toTheFirst([&](FakeServer::Connection& connection) {
        if (linkUp(connection)) {
            StepMessage message = stepOf(1, 1);
            message.step.engaged = true;
            message.step.path.clear();
            for (std::size_t i = 0; i < sand::kMaxPathPoints; ++i) {
                message.step.path.push_back({i % 2 == 0 ? -sand::kMaxProbe : sand::kMaxProbe, 0, 0});
                if (message.step.path.size() == 2) {
                    connection.send(message);  // 2^17 sub-steps: the longest way of a hand
                    ++message.step.number;
                }
            }
            connection.send(message);
            connection.await<Bye>();
        }
    }));
    Client client(server.address(), kOffer);
    grantWhenOffered(client, 1, 0);
    EXPECT_TRUE(eventually([&] { return refusedForGarbage(client) == 1; }, 10000ms));
    // 63 ways of 2 * 65536 cells each.
    EXPECT_NE(client.lastFailure().find("step 2 has a path of 8257536 sub-steps; a step of this sand has at most "
                                        "2097152"),
              std::string::npos)
        << client.lastFailure();
    EXPECT_EQ(client.drain(10).size(), 1U) << "the step before it counts";
}

StepMessage editOf(std::uint64_t number, const sand::Edit& edit) {
    StepMessage message = stepOf(1, number);
    message.step.edit = edit;
    return message;
}

// Without this, a server could fill memory and journal with sand that no operator has loaded.
TEST(Client, EndsTheLinkOverAnEditThatItHasNotAskedFor) {
    const std::array<sand::Edit, 2> edits{withNumber(1, sand::Edit::loaded(base::Bytes(60'000, 7))),
                                          withNumber(2, sand::Edit::settle)};
    for (const sand::Edit& edit : edits) {
        FakeServer server(toTheFirst([&](FakeServer::Connection& connection) {
            if (linkUp(connection)) {
                connection.send(stepOf(1, 1));
                connection.send(editOf(2, edit));
                connection.await<Bye>();
            }
        }));
        Client client(server.address(), kOffer);
        grantWhenOffered(client, 1, 0);
        EXPECT_TRUE(eventually([&] { return refusedForGarbage(client) == 1; }, 10000ms));
        const auto steps = client.drain(10);
        ASSERT_EQ(steps.size(), 1U);
        EXPECT_FALSE(steps[0].step.edit.any());
    }
}

TEST(Client, TakesALoadOnceByItsNumberAndKeepsOneCopyOfItsSand) {
    const sand::Edit load = withNumber(41, sand::Edit::loaded(base::Bytes(1'000'000, 7)));
    const sand::Edit again = withNumber(42, sand::Edit::loaded(base::Bytes(1'000'000, 7)));
    const sand::Edit answer = withNumber(41, sand::Edit::load), answerToAgain = withNumber(42, sand::Edit::load);
    FakeServer server(toTheFirst([&](FakeServer::Connection& connection) {
        connection.reader.expectLoads(true);
        if (linkUp(connection) && connection.await<EditRequest>()) {
            connection.send(editOf(1, answer));
            connection.await<EditRequest>();
            connection.send(editOf(2, answerToAgain));
            connection.send(editOf(3, answerToAgain));
            connection.await<Bye>();
        }
    }));
    Client client(server.address(), kOffer);
    grantWhenOffered(client, 1, 0);
    ASSERT_TRUE(reaches(client, Link::linked)) << client.link().message;
    client.request(load);
    ASSERT_TRUE(eventually([&] { return client.counters().stepsIn == 1; }));
    client.request(again);
    EXPECT_TRUE(eventually([&] { return refusedForGarbage(client) == 1; }, 10000ms)) << "a number twice";
    const auto steps = client.drain(10);
    ASSERT_EQ(steps.size(), 2U);
    EXPECT_EQ(steps[0].step.edit.number, 41U);
    EXPECT_EQ(steps[0].step.edit.sand, load.sand) << "the same bytes in memory";
    EXPECT_EQ(steps[1].step.edit.number, 42U) << "the same sand, loaded again";
    EXPECT_EQ(steps[1].step.edit.sand, again.sand);
}

// The master has the sand of a load, so no server sends it back.
TEST(Client, EndsTheLinkOverAStepAsLongAsALoad) {
    const sand::Edit load = withNumber(1, sand::Edit::loaded(base::Bytes(100'000, 7)));
    FakeServer server(toTheFirst([&](FakeServer::Connection& connection) {
        connection.reader.expectLoads(true);
        if (linkUp(connection) && connection.await<EditRequest>()) {
            connection.send(editOf(1, load));
            connection.await<Bye>();
        }
    }));
    Client client(server.address(), kOffer);
    grantWhenOffered(client, 1, 0);
    ASSERT_TRUE(reaches(client, Link::linked)) << client.link().message;
    client.request(load);
    EXPECT_TRUE(eventually([&] { return refusedForGarbage(client) == 1; }, 10000ms));
    EXPECT_TRUE(client.drain(10).empty());
}

TEST(Client, AnswersATimingTestAtOnceAndAgainWhenAFrameThatTookItIsShown) {
    std::atomic<bool> received = false;
    std::atomic<int> framesBefore = -1;
    FakeServer server([&](FakeServer::Connection& connection) {
        if (!linkUp(connection)) {
            return;
        }
        connection.send(stepOf(1, 1));
        connection.send(stepOf(1, 2));
        connection.send(TimingTest{5, 40});
        connection.send(stepOf(1, 3));
        received = connection.await<TimingEcho>() == TimingEcho{5, Leg::received};
        for (int frames = 0; const auto message = connection.next();) {
            frames += std::holds_alternative<Shown>(*message) ? 1 : 0;
            if (*message == Message(TimingEcho{5, Leg::shown})) {
                framesBefore = frames;
                break;
            }
        }
        connection.await<Bye>();
    });
    Client client(server.address(), kOffer);
    grantWhenOffered(client, 1, 0);
    ASSERT_TRUE(eventually([&] { return client.counters().stepsIn == 3; }));
    EXPECT_TRUE(eventually([&] { return received.load(); })) << "the first echo comes before any frame";
    client.shown({0, 1});  // this frame began before the test came
    EXPECT_EQ(client.drain(1).size(), 1U);
    client.shown({1, 1});  // this frame took only a part of the steps before the test
    EXPECT_EQ(client.drain(1).size(), 1U);
    client.shown({2, 1});  // this frame took all steps before the test
    client.shown({3, 1});
    EXPECT_TRUE(eventually([&] { return framesBefore >= 0; }));
    EXPECT_EQ(framesBefore, 3);
}

TEST(Client, HoldsAFloodBackAndLosesNothing) {
    constexpr std::uint64_t kSteps = 5000;
    FakeServer server([](FakeServer::Connection& connection) {
        if (linkUp(connection)) {
            for (std::uint64_t number = 1; number <= kSteps; ++number) {
                connection.send(stepOf(1, number));
            }
            connection.await<Bye>();
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
}  // namespace
