// SPDX-License-Identifier: Apache-2.0
// The master's steps while its haptic server is wrong, silent or stopped. The timeouts use a clock that the test moves.
#include "master/steps/live_steps.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <thread>

#include "tests/haptic_bridge/client/sand_server.hpp"
#include "tests/support/sand_samples.hpp"
#include "tests/support/server_process.hpp"

namespace {

using haptic_bridge::TimedStep;
using samples::withNumber;
using test::eventually;
using test::FakeServer;
using test::SandServer;
using namespace std::chrono_literals;

constexpr std::int64_t kFrameNs = 16'666'667;
constexpr std::chrono::milliseconds kLooks = 1200ms;  // time in which a link looks at its clock twice

/// A wall without ranks. It shows each step that it takes.
class LiveStepsTest : public testing::Test {
protected:
    master::LiveSteps stepsFrom(const haptic_bridge::Address& server) {
        return {server, scene_, haptic_bridge::Pace::fast, 0, {}, [this] { return nowNs_.load(); }};
    }
    void pass(double seconds) { nowNs_ += static_cast<std::int64_t>(seconds * 1e9); }
    /// Shows one frame, and returns its steps.
    std::vector<TimedStep> show(master::LiveSteps& live, std::size_t most = 4) {
        std::vector<TimedStep> steps = live.next(wall_, wall_.stateHash(), most);
        for (const TimedStep& timed : steps) {
            wall_.apply(timed.step);
            if (timed.step.edit.any()) {
                edits_.push_back(timed.step.edit);
            }
        }
        live.shown(wall_.stepNumber(), kFrameNs, haptic_bridge::Held::no);
        differed_ += live.proveServer(steps, wall_.stateHash()) ? 0 : 1;
        return steps;
    }
    template <class Done>
    bool showUntil(master::LiveSteps& live, const Done& done) {
        return eventually([&] {
            show(live);
            return done();
        });
    }
    /// Returns whether the master numbers the steps.
    bool numbersAlone(master::LiveSteps& live) {
        const std::vector<TimedStep> steps = show(live);
        return !live.linked() && steps.size() == 1 && steps[0].serverHash == 0 && steps[0].step.epoch == live.epoch();
    }
    static std::uint64_t refusedForSilence(const master::LiveSteps& live) {
        return live.counters().refused[static_cast<std::size_t>(haptic_bridge::RefusalCode::limit) - 1];
    }

    const scene::Scene scene_ = samples::flatScene(32, 24);
    sand::Replica wall_{scene_};
    std::atomic<std::int64_t> nowNs_{1'000'000'000};
    int differed_ = 0;
    std::vector<sand::Edit> edits_;  // of the steps that were shown
};

TEST_F(LiveStepsTest, APointerMovesTheToolOnceInEachFrameAlsoIfFramesAreNotPunctual) {
    master::LiveSteps live(std::nullopt, scene_, haptic_bridge::Pace::realtime, 0, {},
                           [this] { return nowNs_.load(); });
    std::array<lockstep::PointerReport, 2> reports{};
    live.pointed(reports, wall_, nowNs_);
    EXPECT_STREQ(live.hand(), "hand points");
    for (int frame = 0; frame < 60; ++frame) {
        nowNs_ += kFrameNs + (frame % 3 - 1) * 400'000;
        const std::int64_t read = nowNs_ - 5'000'000, received = nowNs_ - 1'000'000;
        reports[1].count = 1;
        reports[1].samples[0] = {read, {2048 + 64 * frame, 2048, 0}, 0, 1, {}};
        live.pointed(reports, wall_, received);
        const std::vector<TimedStep> steps = show(live);
        ASSERT_EQ(steps.size(), 1U) << "frame " << frame;
        ASSERT_EQ(steps[0].step.path.size(), 1U);
        EXPECT_EQ(steps[0].step.path[0].x, 2048 + 64 * frame);
        EXPECT_EQ(steps[0].serverTimeNs, read) << "for the latency of the hand";
        EXPECT_EQ(steps[0].receivedNs, received);
    }
    EXPECT_FALSE(live.linked());
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
        if (!connection.await<haptic_bridge::Start>()) {
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

// The pauses before the next four links are 0.1, 0.2, 0.4 and 0.8 s. Without longer pauses four links take 0.4 s. A
// slow machine only makes them longer.
TEST_F(LiveStepsTest, AServerThatFailsRightAfterEachLinkIsAskedMoreRarelyEachTime) {
    FakeServer server([&](FakeServer::Connection& connection) {
        if (connection.await<haptic_bridge::Hello>()) {
            connection.send(haptic_bridge::Welcome{
                {haptic_bridge::kProtocolVersion, sand::kAlgorithmVersion, scene_.rules.digest(), scene_.name}, 60});
            if (connection.await<haptic_bridge::Start>()) {
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

TEST_F(LiveStepsTest, EditsGoToTheServerOneByOneAndEachIntoOneStep) {
    SandServer server(scene_);
    master::LiveSteps live = stepsFrom(server.address());
    ASSERT_TRUE(showUntil(live, [&] { return wall_.stepNumber() >= 5; }));
    const base::Bytes sand = wall_.copySand()->encode();
    const std::vector<sand::Edit> asked{withNumber(1, sand::Edit::settle), withNumber(2, sand::Edit::settle),
                                        withNumber(3, sand::Edit::loaded(sand)),
                                        withNumber(4, sand::Edit::loaded(sand)), withNumber(5, sand::Edit::reset)};
    for (const sand::Edit& edit : asked) {
        live.request(edit);
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
        const auto start = connection.await<haptic_bridge::Start>();
        if (!start) {
            return;
        }
        connection.send(haptic_bridge::Ready{});
        if (server.connections() > 1) {  // it does the edit late, in the next epoch
            connection.send(haptic_bridge::StepMessage{
                1, 1, {start->epoch, start->stepNumber + 1, false, {}, withNumber(1, sand::Edit::settle)}});
            connection.await<haptic_bridge::Bye>();
        } else if (connection.await<haptic_bridge::EditRequest>()) {
            ++asked;  // the server then closes the link
        }
    });
    master::LiveSteps live = stepsFrom(server.address());
    ASSERT_TRUE(showUntil(live, [&] { return live.linked(); }));
    live.request(withNumber(1, sand::Edit::settle));
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
    master::LiveSteps live = stepsFrom(server.address());
    ASSERT_TRUE(showUntil(live, [&] { return wall_.stepNumber() >= 5; }));
    live.request(withNumber(8, sand::Edit::settle));
    ASSERT_TRUE(showUntil(live, [&] { return differed_ > 0; }));
    ASSERT_FALSE(live.linked());
    live.request(withNumber(9, sand::Edit::settle));
    live.request(withNumber(10, sand::Edit::settle));
    ASSERT_TRUE(showUntil(live, [&] { return server.links() == 2 && live.linked(); }));
    live.request(withNumber(11, sand::Edit::settle));
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
        if (connection.await<haptic_bridge::Start>()) {
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
