// SPDX-License-Identifier: Apache-2.0
// Edits, ticks and the share of the force, between the master's steps and a haptic server.
#include <gtest/gtest.h>

#include <atomic>

#include "tests/master/steps/live_steps_fixture.hpp"

namespace {

using samples::withNumber;
using test::eventually;
using test::FakeServer;
using test::kLooks;
using test::LiveStepsTest;
using test::SandServer;

TEST_F(LiveStepsTest, EditsGoToTheServerOneByOneAndEachIntoOneStep) {
    SandServer server(scene_);
    master::LiveSteps live = stepsFrom(server.address());
    ASSERT_TRUE(showUntil(live, [&] { return wall_.stepNumber() >= 5; }));
    const base::Bytes sand = wall_.copySand()->encode();
    const std::vector<sand::Edit> asked{withNumber(1, sand::Edit::settle), withNumber(2, sand::Edit::settle),
                                        withNumber(3, sand::Edit::loaded(sand)),
                                        withNumber(4, sand::Edit::loaded(sand)), withNumber(5, sand::Edit::reset)};
    for (const sand::Edit& edit : asked) {
        asked_.add(edit, {}, {});
    }
    ASSERT_TRUE(showUntil(live, [&] { return edits_.size() == 5; }));
    EXPECT_EQ(edits_, asked) << "in the order in which they were asked for, also if two are equal";
    EXPECT_EQ(edits_[2].sand, asked[2].sand) << "the same bytes in memory";
    const std::uint64_t then = wall_.stepNumber();
    ASSERT_TRUE(showUntil(live, [&] { return wall_.stepNumber() > then + 20; }));
    EXPECT_EQ(edits_.size(), 5U);
    EXPECT_EQ(server.requests(), 5);
    EXPECT_FALSE(server.crowded()) << "a server keeps one for its next step";
    EXPECT_EQ(differed_, 0);
}

TEST_F(LiveStepsTest, AnEditThatALostServerTookAlongIsDoneByTheNextWhoNumbers) {
    std::atomic<int> asked = 0;
    FakeServer server([&](FakeServer::Connection& connection) {
        if (!connection.await<haptic_bridge::Hello>()) {
            return;
        }
        connection.send(haptic_bridge::Welcome{
            {haptic_bridge::kProtocolVersion, sand::kAlgorithmVersion, scene_.rules.digest(), scene_.name}, 60});
        const auto start = connection.await<haptic_bridge::StartMessage>();
        if (!start) {
            return;
        }
        connection.send(haptic_bridge::Ready{});
        if (server.connections() > 1) {  // it does the edit late, in the next epoch
            haptic_bridge::StepMessage late{
                1, 1, {start->epoch, start->stepNumber + 1, false, {}, withNumber(1, sand::Edit::settle)}};
            late.step.sweeps = 1;
            connection.send(late);
            connection.await<haptic_bridge::Bye>();
        } else if (connection.await<haptic_bridge::EditRequest>()) {
            ++asked;  // the server then closes the link
        }
    });
    master::LiveSteps live = stepsFrom(server.address());
    ASSERT_TRUE(showUntil(live, [&] { return live.linked(); }));
    asked_.add(sand::Edit::settle, {}, {});
    ASSERT_TRUE(showUntil(live, [&] { return edits_.size() == 1; }));
    EXPECT_EQ(asked, 1);
    EXPECT_FALSE(live.linked());
    EXPECT_EQ(edits_[0].number, 1U);
    const auto garbage = [&] {
        return live.counters().refused[static_cast<std::size_t>(haptic_bridge::RefusalCode::garbage) - 1];
    };
    ASSERT_TRUE(showUntil(live, [&] { return garbage() == 1; })) << "it was not asked for in this epoch";
    for (int frame = 0; frame < 20; ++frame) {
        show(live);
    }
    EXPECT_EQ(edits_.size(), 1U) << "each number is in one step";
}

// The server of the first link is wrong from step 30 on. The master then numbers the steps until it is linked again.
TEST_F(LiveStepsTest, EditsKeepTheirNumbersOverEpochs) {
    SandServer server(scene_, [](int link, std::uint64_t step, std::uint64_t hash) {
        return link == 1 && step >= 30 ? hash ^ 1 : hash;
    });
    asked_ = master::Edits(7);
    master::LiveSteps live = stepsFrom(server.address());
    ASSERT_TRUE(showUntil(live, [&] { return wall_.stepNumber() >= 5; }));
    asked_.add(sand::Edit::settle, {}, {});
    ASSERT_TRUE(showUntil(live, [&] { return differed_ > 0; }));
    ASSERT_FALSE(live.linked());
    asked_.add(sand::Edit::settle, {}, {});
    asked_.add(sand::Edit::settle, {}, {});
    ASSERT_TRUE(showUntil(live, [&] { return server.links() == 2 && live.linked(); }));
    asked_.add(sand::Edit::settle, {}, {});
    ASSERT_TRUE(showUntil(live, [&] { return edits_.size() == 4; }));
    const std::uint64_t then = wall_.stepNumber();
    ASSERT_TRUE(showUntil(live, [&] { return wall_.stepNumber() > then + 20; }));
    std::vector<std::uint64_t> numbers;
    for (const sand::Edit& edit : edits_) {
        numbers.push_back(edit.number);
    }
    EXPECT_EQ(numbers, (std::vector<std::uint64_t>{8, 9, 10, 11}));
    EXPECT_GE(live.epoch(), 3U);
}

// A server may send 50,000 messages a second, and each piece goes into the journal.
TEST_F(LiveStepsTest, TicksThatNoHandCanMakeAreLeftOut) {
    constexpr int kPieces = 400;
    constexpr std::size_t kPiece = 60'000;
    std::atomic<bool> sent = false;
    FakeServer server(test::toTheFirst([&](FakeServer::Connection& connection) {
        if (!connection.await<haptic_bridge::Hello>()) {
            return;
        }
        connection.send(haptic_bridge::Welcome{
            {haptic_bridge::kProtocolVersion, sand::kAlgorithmVersion, scene_.rules.digest(), scene_.name}, 60});
        if (connection.await<haptic_bridge::StartMessage>()) {
            connection.send(haptic_bridge::Ready{});
            const base::Bytes piece = haptic_bridge::encode(haptic_bridge::TickPiece{base::Bytes(kPiece, 1)});
            for (int i = 0; i < kPieces; ++i) {
                connection.send(piece);
            }
            sent = true;
            connection.await<haptic_bridge::Bye>();
        }
    }));
    master::LiveSteps live = stepsFrom(server.address());
    std::size_t bytes = 0;
    const auto keep = [&] {
        for (const base::Bytes& piece : live.ticks()) {
            bytes += piece.size();
        }
    };
    ASSERT_TRUE(showUntil(live, [&] {
        keep();
        return sent.load();
    }));
    const bool all = eventually(
        [&] {
            show(live);
            keep();
            return bytes > std::size_t{kPieces} * kPiece / 2;
        },
        kLooks);
    EXPECT_FALSE(all) << bytes;
    EXPECT_GT(bytes, kPiece);
}

TEST_F(LiveStepsTest, EveryServerBeginsWithTheShareThatAnOperatorHasSet) {
    SandServer server(scene_, [](int link, std::uint64_t step, std::uint64_t hash) {
        return link == 1 && step >= 40 ? hash ^ 1 : hash;
    });
    master::LiveSteps live = stepsFrom(server.address());
    ASSERT_TRUE(showUntil(live, [&] { return live.linked(); }));
    using haptic_bridge::ForceShare;
    EXPECT_EQ(server.shares(), (std::vector<ForceShare>{{1, false}})) << "no operator has set a share";
    live.shareForce(0.5);
    ASSERT_TRUE(showUntil(live, [&] { return wall_.stepNumber() >= 30; }));
    EXPECT_EQ(server.shares(), (std::vector<ForceShare>{{1, false}, {0.5, true}}));
    ASSERT_TRUE(showUntil(live, [&] { return server.links() == 2; }));
    const std::uint64_t then = wall_.stepNumber();
    ASSERT_TRUE(showUntil(live, [&] { return server.shown() > then + 20; }));
    EXPECT_EQ(server.shares(), (std::vector<ForceShare>{{1, false}, {0.5, true}, {0.5, true}})) << "once per link";
}

TEST_F(LiveStepsTest, AShareThatIsSetBeforeAServerLinksIsThatOfItsFirstStep) {
    SandServer server(scene_);
    master::LiveSteps live = stepsFrom(server.address());
    live.shareForce(0);
    ASSERT_TRUE(showUntil(live, [&] { return live.linked(); }));
    EXPECT_EQ(server.shares(), (std::vector<haptic_bridge::ForceShare>{{0, true}}));
}

}  // namespace
