// SPDX-License-Identifier: Apache-2.0
// Counts the outcomes of ticks in which the law asks for force, on a whole server under a virtual clock. The report's
// line `force` judges these counts (scripts/launcher/ask/session_lines.py).
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "tests/haptic_bridge/loop/strong_arm.hpp"
#include "tests/haptic_bridge/loop/virtual_server.hpp"
#include "tests/support/hand/arm_on_sand.hpp"

namespace {

using namespace haptic_bridge;

constexpr double kToolOfArm = 0.006;  // [m], radius of the tool, in metres of the arm

class AskedForce : public testing::Test {
protected:
    /// Begins a server whose arm rests a tool's radius deep, or moves there to and fro by `swing` [m].
    void open(double ceiling = 1, double swing = 0) {
        server_ = std::make_unique<test::VirtualServer>(
            scene_, test::strongArm(),
            [this, swing](double time) {
                return ArmReading{{swing * std::sin(6 * time), 0, -kToolOfArm}, true, clutch_, present_};
            },
            ceiling);
        counted_ = {};
        asks_ = 0;
        server_->link();
    }
    void tick() {
        server_->tick();
        asks_ += norm(server_->last().lawful) > 0 || !present_ ? 1 : 0;
    }
    void run(int ticks) {
        for (; ticks > 0; --ticks) {
            tick();
        }
    }
    /// Returns the number of ticks with an outcome since the last call of forget().
    [[nodiscard]] std::uint64_t counted(ForceOutcome outcome) const {
        const auto at = static_cast<std::size_t>(outcome);
        return server_->hand().handTicks().asked()[at] - counted_[at];
    }
    /// Leaves out the ticks so far, such as those of the start.
    void forget() {
        counted_ = server_->hand().handTicks().asked();
        asks_ = 0;
    }
    /// Expects that each tick that asks for force has one outcome, and only these.
    void expectOnly(std::initializer_list<ForceOutcome> outcomes) const {
        std::uint64_t sum = 0;
        for (const ForceOutcome outcome : outcomes) {
            EXPECT_GT(counted(outcome), 0U) << base::nameOf(outcome);
            sum += counted(outcome);
        }
        EXPECT_EQ(sum, asks_);
    }

    scene::Scene scene_ = test::levelSand({}, 128, 0.25);
    std::unique_ptr<test::VirtualServer> server_;
    bool present_ = true, clutch_ = false;  // of the arm's readings
    OutcomeCounts counted_{};
    std::uint64_t asks_ = 0;  // ticks in which the law asks for force
};

TEST_F(AskedForce, IsHadInAGoodSessionExceptInTheRampOfItsStart) {
    open();
    run(10'000);
    expectOnly({ForceOutcome::start, ForceOutcome::half});
    // The ramp of two seconds reaches half of the force after one.
    EXPECT_NEAR(static_cast<double>(counted(ForceOutcome::start)), 1000, 20);
    EXPECT_EQ(server_->hand().handTicks().faultedSeconds(), 0U);
}

TEST_F(AskedForce, OfAStiffSceneOnASoftArmIsHadToo) {
    scene_.force.stiffness = 1e5;  // the gain is 0.003
    open();
    run(5'000);
    expectOnly({ForceOutcome::start, ForceOutcome::half});
    EXPECT_GT(counted(ForceOutcome::half), 3'900U);
}

TEST_F(AskedForce, OfAnArmThatLosesReadingsHasTheFaultInEachSecond) {
    open();
    for (int i = 0; i < 10'000; ++i) {
        present_ = i % 250 != 100;
        tick();
    }
    EXPECT_EQ(server_->hand().handTicks().faultedSeconds(), 10U);
    EXPECT_EQ(server_->counted(Guard::unread), 40U);
    EXPECT_GT(counted(ForceOutcome::half), 8'900U) << "one lost reading does not count as a fall";
}

TEST_F(AskedForce, OfAnArmThatIsLostForLongIsNotHadBecauseOfIt) {
    open();
    run(3'000);
    forget();
    present_ = false;
    run(5'000);
    EXPECT_GT(counted(ForceOutcome::lost), 4'980U) << "a fade may take 10 ticks";
    EXPECT_EQ(counted(ForceOutcome::lost) + counted(ForceOutcome::half), asks_);
}

TEST_F(AskedForce, OfASessionWhoseMasterStandsStillAgainAndAgainIsNotHadForLackOfSteps) {
    open();
    for (int i = 0; i < 18'000; ++i) {
        server_->sandIsStopped = i % 1000 >= 550;  // 0.45 s in each second; for 0.13 s the server runs ahead
        tick();
    }
    expectOnly({ForceOutcome::start, ForceOutcome::steps});  // the ramp of the start has not reached half before
    EXPECT_GT(counted(ForceOutcome::steps), asks_ * 9 / 10);
}

TEST_F(AskedForce, OfAToolInSlowMotionIsNotHadForThatReason) {
    // A sweep takes longer than a frame has for sand, so that each step runs one of 64. The hand waits for a second.
    scene_.rules.tuning.sweepsPerStep = 64;
    open(1, 0.02);
    server_->cost = {.sweeps = 1, .substeps = 1, .sweepNs = 20'000'000, .dragNs = 0, .hashNs = 0, .drawNs = 0};
    run(10'000);
    EXPECT_LT(counted(ForceOutcome::half), asks_ / 10);
    EXPECT_GT(counted(ForceOutcome::slowMotion), asks_ / 2);
    EXPECT_EQ(counted(ForceOutcome::steps), 0U);
}

TEST_F(AskedForce, ThatAPersonHasSwitchedOffIsOff) {
    open(0);  // --force off
    run(7'459);
    EXPECT_EQ(asks_, 7'459U);
    expectOnly({ForceOutcome::off});
}

TEST_F(AskedForce, NamesTheChoicesOfAPerson) {
    open();
    run(3'000);
    forget();
    server_->share(ForceShare{0.3, true});
    run(1'000);
    server_->share(ForceShare{1, true});
    run(1'000);
    expectOnly({ForceOutcome::share, ForceOutcome::half});
    forget();
    clutch_ = true;
    run(1'000);
    clutch_ = false;
    run(1'000);
    expectOnly({ForceOutcome::clutch, ForceOutcome::half});
    // The ramp of half a second reaches half of the force after a quarter.
    EXPECT_NEAR(static_cast<double>(counted(ForceOutcome::half)), 770, 10);
    for (const auto& [held, outcome] :
         {std::pair{Held::pause, ForceOutcome::pause}, std::pair{Held::disk, ForceOutcome::disk}}) {
        forget();
        server_->held = held;
        server_->sandIsStopped = true;
        run(2'000);
        server_->sandIsStopped = false;
        run(2'000);
        expectOnly({outcome, ForceOutcome::half});
        // 8 steps ahead, 0.25 s, and half of the fade of 0.1 s; then 1 s of steps, and half of the ramp of 0.5 s.
        EXPECT_NEAR(static_cast<double>(counted(outcome)), 2'000 - 8 * 1000. / 60 - 250 - 50 + 1'250, 40);
    }
}

TEST_F(AskedForce, NamesTheGrowthAfterAnEdit) {
    open();
    run(3'000);
    forget();
    sand::Tuning wider = server_->sand().rules().tuning;
    wider.tool.radius *= 4;
    server_->edit(sand::Edit::tuned(wider));
    run(1'000);
    expectOnly({ForceOutcome::growth, ForceOutcome::half});
}

TEST_F(AskedForce, HasOneOutcomeInEachTickWhateverHappens) {
    open(1, 0.02);
    for (int i = 0; i < 6'000; ++i) {
        present_ = i % 700 != 699;
        clutch_ = i % 900 > 850;
        server_->sandIsStopped = i % 1'500 > 1'100;
        server_->sandThreadHangs = i % 2'000 > 1'900;
        if (i % 800 == 0) {
            server_->share(ForceShare{i % 1'600 == 0 ? 1.0 : 0.2, true});
        }
        tick();
    }
    const OutcomeCounts all = server_->hand().handTicks().asked();
    EXPECT_EQ(std::accumulate(all.begin(), all.end(), std::uint64_t{0}), asks_);
}

}  // namespace
