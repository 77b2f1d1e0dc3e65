// SPDX-License-Identifier: Apache-2.0
// Arms that give no reading now and then, on whole servers under a virtual clock.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "haptic_bridge/loop/guards/breaker.hpp"
#include "tests/haptic_bridge/loop/guarded_server.hpp"

namespace {

using namespace haptic_bridge;
using test::kToolInArm;

/// An arm that rests or strokes one tool radius deep. `lost` readings from now on are missing.
class LostReading : public test::GuardedServer {
protected:
    /// Opens a server whose hand strokes to and fro at up to `speed` [m/s], and waits for the whole force.
    void openAndTouch(double speed = 0) {
        stroke_ = 0;
        open([this, speed](double) {
            stroke_ += 1e-3;
            const double out = speed > 0 ? 0.01 * std::sin(speed / 0.01 * stroke_) : 0;
            ArmReading reading{{place + out, 0, -kToolInArm}, true, false, true};
            reading.present = lost_ == 0 && (every_ == 0 || ++readings_ % every_ != 0);
            lost_ = std::max(lost_ - 1, 0);
            return reading;
        });
        server_->link();
        server_->run(4);
        ASSERT_GT(force(), 0.05);
    }
    void lose(int readings) {
        lost_ = readings;
        server_->run(1e-3 * readings);
    }
    /// Returns the mean force of the next `seconds` [s].
    double meanForce(double seconds) {
        double sum = 0;
        const int ticks = static_cast<int>(std::lround(1000 * seconds));
        for (int tick = 0; tick < ticks; ++tick) {
            server_->tick();
            sum += force();
        }
        return sum / ticks;
    }

    double place = 0;  // [m], of the arm, to the east
    int every_ = 0;    // every so many readings one is missing; 0: none

private:
    double stroke_ = 0;  // [s], of the stroke
    int lost_ = 0, readings_ = 0;
};

// A tenth of the force goes with each millisecond. It comes back by at most 1.5 slew limits per tick.
TEST_F(LostReading, AtMostTenTakeATenthOfTheForceEachAndItComesBackWithoutARamp) {
    forEachLaw(1e4, [this] {
        openAndTouch();
        const double whole = force(), slew = server_->hand().guards().limits().slew;
        for (const int lost : {1, 2, 9}) {
            for (int tick = 1; tick <= lost; ++tick) {
                lose(1);
                EXPECT_NEAR(force(), (1 - 0.1 * tick) * whole, 0.01 * whole) << tick << " of " << lost;
            }
            const double left = force();
            const int back = 2 + static_cast<int>(std::ceil((whole - left) / (1.5 * slew)));  // [tick]
            server_->run(1e-3 * back);
            EXPECT_NEAR(force(), whole, 0.02 * whole) << lost << " readings lost, after " << back << " ticks";
        }
        EXPECT_EQ(server_->counted(Guard::unread), 12U);
        EXPECT_EQ(server_->counted(Guard::lost), 0U);
        EXPECT_LE(server_->counted(Guard::ramp), 2000U) << "only the ramp of the start";
    });
}

TEST_F(LostReading, ElevenAreAFaultWithARampOfTwoSeconds) {
    forEachLaw(1e4, [this] {
        openAndTouch();
        const double whole = force();
        lose(11);
        EXPECT_EQ(force(), 0);
        EXPECT_EQ(server_->counted(Guard::lost), 1U);
        server_->run(1);
        EXPECT_NEAR(force(), whole / 2, 0.1 * whole);
        server_->run(1.1);
        const std::uint64_t ramped = server_->counted(Guard::ramp);
        server_->run(0.5);
        EXPECT_EQ(server_->counted(Guard::ramp), ramped) << "the ramp has ended";
        // The fault has lifted the tool and put it down again. Sand has slid below it meanwhile. Control points feel
        // that, because they lie where the tool cuts.
        EXPECT_NEAR(force(), whole, (scene_.force.law == sand::ForceLaw::repulse ? 0.02 : 0.12) * whole);
    });
}

TEST_F(LostReading, OneIn250LeavesNineTenthsOfTheMeanForce) {
    forEachLaw(1e4, [this] {
        every_ = 0;
        openAndTouch(0.03);
        const double without = meanForce(2);
        every_ = 250;
        openAndTouch(0.03);
        EXPECT_GT(meanForce(2), 0.9 * without);
        EXPECT_GT(server_->counted(Guard::unread), 20U);
        EXPECT_EQ(server_->counted(Guard::lost), 0U);
    });
}

TEST_F(LostReading, AllButEveryTenthIsStillNoFault) {
    openAndTouch();
    const double whole = force();
    for (int burst = 0; burst < 100; ++burst) {
        lose(9);
        server_->tick();
    }
    EXPECT_EQ(server_->counted(Guard::lost), 0U);
    EXPECT_GT(force(), 0);
    server_->run(0.1);
    EXPECT_NEAR(force(), whole, 0.02 * whole);
}

TEST_F(LostReading, OfATouchInTheRampOfAStartStaysInThatRamp) {
    open([this](double) { return ArmReading{{0, 0, -kToolInArm}, true, false, every_ == 0}; });
    server_->link();
    server_->run(1);
    const double half = force();
    every_ = 1;
    server_->tick();
    every_ = 0;
    server_->run(1.1);
    EXPECT_NEAR(force(), 2 * half, 0.05 * half) << "the ramp continues";
}

// The tool stays in the sand. To lift it and to press it again would take two steps of their own.
TEST_F(LostReading, LeavesTheToolWhereItIs) {
    openAndTouch(0.03);
    int lifted = 0;
    server_->onStep = [&lifted](const base::Bytes& message) {
        constexpr std::size_t kLength = 4;  // [byte], of the length of a message
        lifted += std::get<StepMessage>(decode(std::span(message).subspan(kLength))).step.engaged ? 0 : 1;
    };
    every_ = 50;
    server_->run(2);
    EXPECT_GT(server_->counted(Guard::unread), 30U);
    EXPECT_EQ(lifted, 0);
    every_ = 0;
    lose(60);
    EXPECT_GT(lifted, 0) << "a device that does not answer lifts the tool";
}

TEST_F(LostReading, AnArmThatIsElsewhereAfterASilenceHasJumped) {
    openAndTouch();
    lose(4);
    EXPECT_GT(force(), 0);
    place = 0.05;  // further than half of the reach
    server_->tick();
    EXPECT_EQ(force(), 0);
    EXPECT_EQ(server_->counted(Guard::unread), 4U);
    server_->run(0.5);
    EXPECT_LT(force(), 1) << "the ramp of two seconds";
}

TEST_F(LostReading, AnyFaultDuringASilenceSendsZeroAtOnce) {
    openAndTouch();
    lose(1);
    EXPECT_GT(force(), 0);
    place = std::nan("");
    server_->tick();
    EXPECT_EQ(force(), 0) << "a place that is not a number";
    place = 0;
    server_->run(3);
    lose(1);
    EXPECT_GT(force(), 0);
    server_->tick(15'000'000);
    EXPECT_EQ(force(), 0) << "missed ticks";
}

TEST_F(LostReading, ThreeRampsInTenSecondsSwitchTheForceOffUntilAnOperatorSwitchesItOn) {
    openAndTouch();
    const double whole = force();
    for (int ramp = 1; ramp <= 2; ++ramp) {
        lose(20);
        server_->run(2.5);
        EXPECT_NEAR(force(), whole, 0.05 * whole) << "after ramp " << ramp;
    }
    lose(20);
    EXPECT_TRUE(server_->hand().tripped());
    server_->run(20);
    EXPECT_EQ(greatest(20), 0);
    EXPECT_GE(server_->counted(Guard::tripped), 20'000U);
    server_->share(ForceShare{1, false});
    server_->share(ForceShare{0, true});
    server_->unlink();
    server_->link({1, true});
    server_->run(3);
    EXPECT_EQ(greatest(3), 0) << "a share that no operator switches on, and another link";
    server_->share(ForceShare{1, true});  // the share is unchanged
    server_->run(1);
    EXPECT_NEAR(force(), whole / 2, 0.1 * whole) << "the ramp of two seconds";
    server_->run(1.1);
    EXPECT_NEAR(force(), whole, 0.05 * whole);
    EXPECT_FALSE(server_->hand().tripped());
    lose(20);
    server_->run(3);
    EXPECT_GT(force(), 0) << "the earlier faults are forgotten";
}

TEST_F(LostReading, ThreeRampsInMoreThanTenSecondsKeepTheForce) {
    openAndTouch();
    for (int ramp = 0; ramp < 6; ++ramp) {
        lose(20);
        server_->run(5.1);
        EXPECT_GT(force(), 0.5) << ramp;
    }
    EXPECT_EQ(server_->counted(Guard::tripped), 0U);
}

TEST_F(LostReading, StartsPausesAndShortSilencesAreNoRamps) {
    openAndTouch();
    for (int time = 0; time < 4; ++time) {
        server_->unlink();
        server_->link();
        server_->run(0.3);
        lose(5);
        server_->share(ForceShare{0, true});
        server_->run(0.1);
        server_->share(ForceShare{1, false});
        server_->sandIsStopped = true;
        server_->run(0.6);
        server_->sandIsStopped = false;
        server_->run(0.1);
    }
    server_->run(3);
    EXPECT_EQ(server_->counted(Guard::tripped), 0U);
    EXPECT_GT(force(), 0.5);
}

// 3 mm in three ticks, under 1, 0.9 and 0.8 N.
TEST(PassivityObserver, CountsTheWayOfASilenceWithTheForcesThatHaveActed) {
    ArmPhysics arm = test::strongArm();
    arm.delayTicks = 0;
    PassivityObserver observer(ForceLimits::of(arm, 1, {}, 0));
    observer.observe({}, 0);
    observer.sent({1, 0, 0});
    observer.wait(1e-3);
    observer.sent({0.9, 0, 0});
    observer.wait(1e-3);
    observer.sent({0.8, 0, 0});
    observer.observe({3e-3, 0, 0}, 1e-3);
    EXPECT_NEAR(observer.returned(), 0.9 * 3e-3, 1e-12);
    observer.sent({0.5, 0, 0});
    observer.observe({4e-3, 0, 0}, 1e-3);
    EXPECT_NEAR(observer.returned(), 0.9 * 3e-3 + 0.5 * 1e-3, 1e-12);
}

TEST(Breaker, CountsFaultsWithoutAGapOnceAndItsOwnTicksNever) {
    Breaker breaker;
    double time = 0;
    const auto pass = [&](Guard guard, int ticks) {
        for (int tick = 0; tick < ticks; ++tick) {
            breaker.take(time += 1e-3, bit(guard));
        }
        breaker.take(time += 1e-3, 0);
    };
    pass(Guard::stale, 500);
    pass(Guard::ramp, 500);
    pass(Guard::frozen, 500);
    pass(Guard::missed, 1);
    EXPECT_FALSE(breaker.tripped());
    pass(Guard::jumped, 1);
    EXPECT_TRUE(breaker.tripped());
    pass(Guard::tripped, 20'000);
    EXPECT_TRUE(breaker.tripped());
    breaker.reset();
    for (int fault = 0; fault < 10; ++fault) {
        time += 5.01;
        pass(Guard::notANumber, 1);
        EXPECT_FALSE(breaker.tripped()) << fault;
    }
}

}  // namespace
