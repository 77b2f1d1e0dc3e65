// SPDX-License-Identifier: Apache-2.0
// The master's steps while its haptic server is wrong, silent or stopped. The timeouts use a clock that the test moves.
#include "master/steps/live_steps.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <random>
#include <thread>

#include "tests/master/steps/live_steps_fixture.hpp"

namespace {

using master::ArrivedStep;
using test::eventually;
using test::FakeServer;
using test::kFrameNs;
using test::kLooks;
using test::LiveStepsTest;
using test::SandServer;
using namespace std::chrono_literals;

// The step is in the journal by then, and all replicas leave it out, that of the server too. So the hashes agree.
TEST_F(LiveStepsTest, AServerWhoseStepIsLeftOutIsDropped) {
    SandServer server(scene_);
    server.payTooMuchIn(6);
    master::LiveSteps live = stepsFrom(server.address());
    ASSERT_TRUE(showUntil(live, [&] { return wall_.stepNumber() >= 6; }));
    EXPECT_FALSE(live.linked());
    EXPECT_EQ(live.lastRefusal(), "it runs 9 sweeps, and 8 are owed");
    EXPECT_EQ(differed_, 0);
    EXPECT_TRUE(numbersAlone(live));
    pass(master::LiveSteps::kRetryWait + 1);
    ASSERT_TRUE(showUntil(live, [&] { return live.linked(); })) << "the master asks the server again";
}

TEST_F(LiveStepsTest, APointerMovesTheToolOnceInEachFrameAlsoIfFramesAreNotPunctual) {
    master::LiveSteps live(std::nullopt, scene_, asked_, haptic_bridge::Pace::realtime, 0, {},
                           [this] { return nowNs_.load(); });
    std::array<haptic_bridge::PointerReport, 2> reports{};
    live.pointed(reports, 0.5, wall_, nowNs_);
    EXPECT_STREQ(live.hand(), "hand points");
    for (int frame = 0; frame < 60; ++frame) {
        nowNs_ += kFrameNs + (frame % 3 - 1) * 400'000;
        const std::int64_t read = nowNs_ - 5'000'000, received = nowNs_ - 1'000'000;
        reports[1].count = 1;
        reports[1].samples[0] = {read, {2048 + 64 * frame, 2048, 0}, 0, 1, {}};
        live.pointed(reports, 0.5, wall_, received);
        const std::vector<ArrivedStep> steps = show(live);
        ASSERT_EQ(steps.size(), 1U) << "frame " << frame;
        ASSERT_EQ(steps[0].step.path.size(), 1U);
        EXPECT_EQ(steps[0].step.path[0].x, 2048 + 64 * frame);
        EXPECT_EQ(steps[0].serverTimeNs, read) << "for the latency of the hand";
        EXPECT_EQ(steps[0].receivedNs, received);
    }
    EXPECT_FALSE(live.linked());
}

// A sweep takes 1 ms, and a frame has 8.3 ms for sand.
TEST_F(LiveStepsTest, AFrameTakesTheOwnStepsThatFit) {
    master::LiveSteps live(std::nullopt, scene_, asked_, haptic_bridge::Pace::realtime, 0, {},
                           [this] { return nowNs_.load(); });
    nowNs_ += 4 * kFrameNs + 1000;
    EXPECT_EQ(show(live).size(), 4U) << "no cost is known";
    const haptic_bridge::FrameCost cost{.sweeps = 8, .sweepNs = 8'000'000};
    live.shown({wall_.stepNumber(), kFrameNs, haptic_bridge::Held::no, cost});
    nowNs_ += 4 * kFrameNs;
    const std::vector<ArrivedStep> steps = live.next(wall_, wall_.stateHash(), 4);
    ASSERT_EQ(steps.size(), 1U);
    EXPECT_EQ(steps[0].step.sweeps, 8) << "all that it owes";
}

TEST_F(LiveStepsTest, AServerWhoseSandDiffersIsLetGoAndStartsAgainFromTheWalls) {
    SandServer server(scene_, [](int link, std::uint64_t step, std::uint64_t hash) {
        return link == 1 && step >= 20 ? hash ^ 1 : hash;
    });
    master::LiveSteps live = stepsFrom(server.address());
    ASSERT_TRUE(showUntil(live, [&] { return wall_.stepNumber() >= 10; }));
    EXPECT_TRUE(live.linked());
    EXPECT_EQ(live.epoch(), 1U);
    EXPECT_EQ(differed_, 0);
    ASSERT_TRUE(showUntil(live, [&] { return differed_ > 0; }));
    EXPECT_FALSE(live.linked());
    EXPECT_EQ(live.epoch(), 2U) << "the master numbers the steps";
    const std::uint64_t then = wall_.stepNumber();
    EXPECT_GE(then, 20U);
    EXPECT_LT(then, 24U) << "in the frame that shows the first wrong step, of four at most";
    ASSERT_TRUE(showUntil(live, [&] { return server.links() == 2 && server.shown() > then + 30; }));
    EXPECT_TRUE(live.linked());
    EXPECT_EQ(live.epoch(), 3U);
    EXPECT_EQ(differed_, 1) << "it has the wall's sand now";
    EXPECT_EQ(server.states(), 1) << "the wall's whole sand";
    EXPECT_EQ(live.counters().reconnects, 1U);
}

TEST_F(LiveStepsTest, AServerWhoseMemoryHasChangedSaysSoAtTheEnd) {
    using haptic_bridge::Audited;
    for (const Audited audited : {Audited::no, Audited::agreed, Audited::differed}) {
        SandServer server(scene_);
        server.answerByeWith(audited);
        master::LiveSteps live = stepsFrom(server.address());
        ASSERT_TRUE(showUntil(live, [&] { return live.linked(); }));
        EXPECT_TRUE(live.handed());
        EXPECT_EQ(live.serverAtEnd(), std::nullopt) << "it is still linked";
        live.stop();
        const std::optional<bool> wanted =
            audited == Audited::no ? std::nullopt : std::optional(audited == Audited::agreed);
        EXPECT_EQ(live.serverAtEnd(), wanted);
        EXPECT_EQ(live.serverUnhealed(), audited == Audited::differed);
    }
}

TEST_F(LiveStepsTest, AServerThatLeavesWithChangedMemoryCountsOnceAndIsHealedWhenItComesBack) {
    SandServer server(scene_);
    server.answerByeWith(haptic_bridge::Audited::agreed);
    master::LiveSteps live = stepsFrom(server.address());
    ASSERT_TRUE(showUntil(live, [&] { return wall_.stepNumber() >= 10; }));
    server.leave(haptic_bridge::Audited::differed);
    ASSERT_TRUE(showUntil(live, [&] { return differed_ > 0; }));
    EXPECT_TRUE(live.serverUnhealed());
    ASSERT_TRUE(showUntil(live, [&] { return server.links() == 2 && live.linked(); }));
    EXPECT_FALSE(live.serverUnhealed()) << "it has begun with the wall's sand";
    ASSERT_TRUE(showUntil(live, [&, then = wall_.stepNumber()] { return wall_.stepNumber() > then + 10; }));
    EXPECT_EQ(differed_, 1);
    live.stop();
    EXPECT_EQ(live.serverAtEnd(), true) << "of the last link";
}

TEST_F(LiveStepsTest, WhyALinkDoesNotComeIsKeptUntilOneComes) {
    master::LiveSteps nobody = stepsFrom({"127.0.0.1", 9});
    EXPECT_FALSE(nobody.handed());
    ASSERT_TRUE(showUntil(nobody, [&] { return !nobody.lastRefusal().empty(); }));
    EXPECT_TRUE(nobody.lastRefusal().starts_with("no answer (")) << nobody.lastRefusal();
    EXPECT_EQ(nobody.counters().links, 0U);

    SandServer server(scene_);
    master::LiveSteps live = stepsFrom(server.address());
    ASSERT_TRUE(showUntil(live, [&] { return live.linked(); }));
    EXPECT_EQ(live.lastRefusal(), "");
    const scene::Scene other = samples::flatScene(40, 24);
    SandServer foreign(other);
    master::LiveSteps refused = stepsFrom(foreign.address());
    ASSERT_TRUE(showUntil(refused, [&] { return !refused.lastRefusal().empty(); }));
    EXPECT_NE(refused.lastRefusal().find("scene"), std::string::npos) << refused.lastRefusal();
}

// When a wrong server comes back, its earlier hashes of the sand do not count.
TEST_F(LiveStepsTest, AServerWithAnotherHistoryGetsNoneOfItBack) {
    SandServer server(scene_, [](int link, std::uint64_t step, std::uint64_t hash) {
        return link == 1 && step >= 5 ? hash ^ step : hash;
    });
    server.claimStep(6);
    master::LiveSteps live = stepsFrom(server.address());
    // Steps 5 to 8 are in one frame. The wall knows its own hash only after the last of them.
    ASSERT_TRUE(eventually([&] { return !show(live, 4).empty(); }));
    while (wall_.stepNumber() < 4) {
        show(live, 4 - wall_.stepNumber());
    }
    ASSERT_EQ(differed_, 0);
    ASSERT_TRUE(eventually([&] { return live.counters().stepsIn >= 8; }));
    ASSERT_EQ(show(live, 4).size(), 4U);
    EXPECT_EQ(differed_, 1);
    ASSERT_TRUE(showUntil(live, [&] { return server.links() == 2; }));
    EXPECT_EQ(server.catchUps(), 0);
    EXPECT_EQ(server.states(), 1);
}

TEST_F(LiveStepsTest, AServerThatTakesTheConnectionAndNeverGreetsIsWaitedForTenSeconds) {
    std::atomic<int> greeted = 0;
    FakeServer server([&](FakeServer::Connection& connection) {
        greeted += connection.await<haptic_bridge::Hello>() ? 1 : 0;
        connection.ignoreTheRest();
    });
    master::LiveSteps live = stepsFrom(server.address());
    ASSERT_TRUE(eventually([&] { return greeted == 1; }));
    pass(9.99);
    EXPECT_TRUE(show(live).empty());
    EXPECT_TRUE(live.starting());
    std::this_thread::sleep_for(kLooks);
    EXPECT_EQ(refusedForSilence(live), 0U);
    pass(0.02);
    show(live);
    EXPECT_FALSE(live.starting());
    EXPECT_EQ(live.epoch(), 1U);
    EXPECT_TRUE(numbersAlone(live)) << "the wall continues without a hand";
    EXPECT_TRUE(showUntil(live, [&] { return refusedForSilence(live) == 1; })) << "the silence is counted";
    EXPECT_TRUE(showUntil(live, [&] { return greeted == 2; })) << "the master tries the server again";
    EXPECT_EQ(live.counters().links, 0U);
}

TEST_F(LiveStepsTest, AServerThatIsStoppedLosesItsLinkAfterTenSeconds) {
    std::atomic<bool> silent = false;
    FakeServer server(test::toTheFirst([&](FakeServer::Connection& connection) {
        if (!connection.await<haptic_bridge::Hello>()) {
            return;
        }
        connection.send(haptic_bridge::Welcome{
            {haptic_bridge::kProtocolVersion, sand::kAlgorithmVersion, scene_.rules.digest(), scene_.name}, 60});
        if (!connection.await<haptic_bridge::StartMessage>()) {
            return;
        }
        connection.send(haptic_bridge::Ready{});
        silent = true;
        connection.ignoreTheRest();  // the kernel still accepts bytes for a stopped process
    }));
    master::LiveSteps live = stepsFrom(server.address());
    ASSERT_TRUE(showUntil(live, [&] { return silent && live.linked(); }));
    EXPECT_EQ(live.epoch(), 1U);
    pass(9.99);
    std::this_thread::sleep_for(kLooks);
    EXPECT_TRUE(show(live).empty()) << "the sand waits for the hand";
    EXPECT_TRUE(live.linked());
    pass(0.02);
    ASSERT_TRUE(showUntil(live, [&] { return !live.linked(); }));
    EXPECT_EQ(live.epoch(), 2U);
    EXPECT_TRUE(numbersAlone(live)) << "the wall continues without a hand";
    EXPECT_EQ(refusedForSilence(live), 0U) << "the server had sent its Welcome";
    EXPECT_EQ(live.counters().links, 1U);
}

TEST_F(LiveStepsTest, AServerThatDoesNotBeginIsPassedOverAfterFiveSecondsAndAskedAgainAfterThirty) {
    FakeServer server([&](FakeServer::Connection& connection) {
        if (connection.await<haptic_bridge::Hello>()) {
            connection.send(haptic_bridge::Welcome{
                {haptic_bridge::kProtocolVersion, sand::kAlgorithmVersion, scene_.rules.digest(), scene_.name}, 60});
            connection.ignoreTheRest();
        }
    });
    master::LiveSteps live = stepsFrom(server.address());
    ASSERT_TRUE(showUntil(live, [&] { return live.epoch() == 1; })) << "the server is asked to number the steps";
    pass(4.99);
    EXPECT_TRUE(show(live).empty());
    EXPECT_EQ(live.epoch(), 1U);
    pass(0.02);
    show(live);
    EXPECT_EQ(live.epoch(), 2U);
    EXPECT_TRUE(numbersAlone(live));
    pass(29.98);
    EXPECT_TRUE(numbersAlone(live));
    std::this_thread::sleep_for(100ms);
    EXPECT_EQ(server.connections(), 1);
    pass(0.04);
    EXPECT_TRUE(showUntil(live, [&] { return server.connections() == 2; }));
}

// A state of 4 MB has one second more.
TEST_F(LiveStepsTest, AServerThatGetsTheWholeSandHasTimeForItsBytes) {
    scene::Scene rough = samples::flatScene(1000, 1000);
    std::mt19937 random(1);
    for (int row = 0; row < 1000; ++row) {
        for (int column = 0; column < 1000; ++column) {
            rough.terrain.setHeight(column, row, static_cast<std::int32_t>(random() % 1'000'000));
        }
    }
    wall_ = sand::Replica(rough);
    FakeServer server([&](FakeServer::Connection& connection) {
        if (connection.await<haptic_bridge::Hello>()) {
            connection.send(haptic_bridge::Welcome{
                {haptic_bridge::kProtocolVersion, sand::kAlgorithmVersion, rough.rules.digest(), rough.name}, 60});
            if (connection.await<haptic_bridge::StartMessage>()) {
                connection.send(haptic_bridge::NeedState{});
            }
            connection.ignoreTheRest();
        }
    });
    master::LiveSteps live{
        server.address(), rough, asked_, haptic_bridge::Pace::fast, 0, {}, [this] { return nowNs_.load(); }};
    ASSERT_TRUE(showUntil(live, [&] { return live.counters().snapshots == 1; }));
    const double seconds = 5 + static_cast<double>(wall_.encodeState().size()) / 4e6;
    ASSERT_GT(seconds, 5.5);
    pass(seconds - 0.01);
    EXPECT_TRUE(show(live).empty());
    EXPECT_EQ(live.epoch(), 1U) << "the server still has time";
    pass(0.02);
    show(live);
    EXPECT_EQ(live.epoch(), 2U);
}

// The pauses before the next four links are 0.1, 0.2, 0.4 and 0.8 s. Without longer pauses four links take 0.4 s. A
// slow machine only makes them longer.
TEST_F(LiveStepsTest, AServerThatFailsRightAfterEachLinkIsAskedMoreRarelyEachTime) {
    FakeServer server([&](FakeServer::Connection& connection) {
        if (connection.await<haptic_bridge::Hello>()) {
            connection.send(haptic_bridge::Welcome{
                {haptic_bridge::kProtocolVersion, sand::kAlgorithmVersion, scene_.rules.digest(), scene_.name}, 60});
            if (connection.await<haptic_bridge::StartMessage>()) {
                connection.send(haptic_bridge::Ready{});
            }
        }
    });
    const auto began = std::chrono::steady_clock::now();
    master::LiveSteps live = stepsFrom(server.address());
    ASSERT_TRUE(showUntil(live, [&] { return server.connections() >= 5; }));
    EXPECT_GE(std::chrono::steady_clock::now() - began, 1500ms);
    EXPECT_GE(live.counters().links, 3U) << "the server was linked each time";
    EXPECT_TRUE(eventually([&] { return !live.linked() && numbersAlone(live); })) << "the wall continues meanwhile";
}

// A server that reads a large scene gets as long as it gets further. Then the wall continues without a hand.
TEST_F(LiveStepsTest, WaitsForAServerThatReadsItsSceneAsLongAsItGetsFurther) {
    std::atomic<std::uint32_t> done = 10;
    std::atomic<bool> over = false;
    FakeServer server([&](FakeServer::Connection& connection) {
        if (!connection.await<haptic_bridge::Hello>()) {
            return;
        }
        while (!over) {
            connection.send(haptic_bridge::Loading{done});
            std::this_thread::sleep_for(60ms);
        }
    });
    master::LiveSteps live = stepsFrom(server.address());
    for (const std::uint32_t read : {10U, 400U, 800U}) {
        done = read;
        std::this_thread::sleep_for(200ms);
        EXPECT_TRUE(show(live).empty()) << "the sand stands still";
        pass(master::LiveSteps::kLoadingWait - 5);
        EXPECT_TRUE(show(live).empty()) << read;
    }
    done = 300;  // a server that begins again must get further than before
    std::this_thread::sleep_for(200ms);
    EXPECT_TRUE(show(live).empty());
    pass(10);
    EXPECT_TRUE(showUntil(live, [&] { return numbersAlone(live); }));
    over = true;
}

}  // namespace
