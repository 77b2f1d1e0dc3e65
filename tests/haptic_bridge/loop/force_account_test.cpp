// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/loop/force_account.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "haptic_bridge/hand/arm_presets.hpp"
#include "haptic_bridge/loop/guards/limited_law.hpp"
#include "tests/support/hand/arm_on_sand.hpp"

namespace {

using namespace haptic_bridge;
using sand::force::Vec3;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Returns a tick in which the law asks for 1 N, and the hand has `sent` [N].
ForceAccount::Tick asks(double sent, std::uint32_t acted = 0) {
    return {.time = 10, .asked = 1, .sent = sent, .acted = acted};
}

TEST(ForceThatIsAsked, OfAStiffSceneIsWhatASoftArmCanBear) {
    const ForceLimits limits = ForceLimits::of(touchPreset(), test::kScale, {500, 50, 5}, 0.67);
    const Guards guards(limits);
    ASSERT_LT(limits.gain, 0.05) << "117 N/m of 6250 N/m";
    Guards::Reading reading;
    reading.felt = {{0, 0, 5}, {0, 0, 1}, 0, 500};
    EXPECT_NEAR(askedForce(guards, reading, {0, 0, 5}), 5 * limits.gain, 1e-12);
    reading.felt = {{0, 0, 5000}, {0, 0, 1}, 0, 500};
    EXPECT_EQ(askedForce(guards, reading, {0, 0, 5000}), limits.maxForce);
    const Guards literal(limits, Guards::Mode::literal);
    EXPECT_EQ(askedForce(literal, reading, {0, 0, 5000}), 5000);
    reading.felt.push.z = kNan;
    EXPECT_TRUE(std::isnan(askedForce(guards, reading, {0, 0, kNan})));
}

TEST(StoppedSand, HasTheCauseThatTheWallTells) {
    constexpr double kStep = 1.0 / 60;
    EXPECT_EQ(stoppedBy({.felt = 0.25, .made = 0.25, .held = Held::no}, kStep), std::nullopt);
    EXPECT_EQ(stoppedBy({.felt = 0.26, .made = 0.26, .held = Held::no}, kStep), ForceOutcome::steps);
    EXPECT_EQ(stoppedBy({.felt = 0.26, .made = 0.02, .held = Held::no}, kStep), ForceOutcome::slowMotion);
    EXPECT_EQ(stoppedBy({.felt = 0.26, .made = 0.26, .held = Held::pause}, kStep), ForceOutcome::pause);
    EXPECT_EQ(stoppedBy({.felt = 0.26, .made = 0.26, .held = Held::disk}, kStep), ForceOutcome::disk);
    EXPECT_EQ(stoppedBy({.felt = 0.26, .made = 0.26, .held = std::nullopt}, kStep), ForceOutcome::start);
    EXPECT_EQ(stoppedBy({.felt = 2.9, .made = 2.9, .held = Held::no}, 1), std::nullopt) << "three steps";
}

TEST(ForceAccount, CountsHalfOfTheForceAndNothingWithoutAForceThatIsAsked) {
    ForceAccount account;
    EXPECT_EQ(account.tick(asks(0.5)), ForceOutcome::half);
    EXPECT_EQ(account.tick(asks(0.5, bit(Guard::ramp) | bit(Guard::frozen))), ForceOutcome::half);
    EXPECT_NE(account.tick(asks(0.499)), ForceOutcome::half);
    EXPECT_EQ(account.tick({.time = 1, .asked = 0, .sent = 0}), std::nullopt);
}

TEST(ForceAccount, NamesAChoiceOfAPersonBeforeAFault) {
    ForceAccount account;
    const auto with = [](double share, bool clutch, double sent, std::uint32_t acted = 0) {
        auto tick = asks(sent, acted);
        tick.share = share;
        tick.clutch = clutch;
        return tick;
    };
    EXPECT_EQ(account.tick(with(0, false, 0, bit(Guard::lost))), ForceOutcome::off);
    EXPECT_EQ(account.tick(with(0.4, false, 0.4)), ForceOutcome::share);
    EXPECT_EQ(account.tick(with(1, true, 0)), ForceOutcome::clutch);
    // 0.8 of the force with a ramp at 0.6 of it is 0.48. Without the share it would be 0.6.
    EXPECT_EQ(account.tick(with(0.8, false, 0.48, bit(Guard::ramp))), ForceOutcome::share);
    account.forget();
    EXPECT_EQ(account.tick(with(0.8, false, 0.32, bit(Guard::ramp))), ForceOutcome::start) << "0.4 without the share";
    auto paused = asks(0, bit(Guard::stale));
    paused.stopped = ForceOutcome::pause;
    EXPECT_EQ(account.tick(paused), ForceOutcome::pause);
}

TEST(ForceAccount, NamesTheRampAfterWhatBeganIt) {
    ForceAccount account;
    EXPECT_EQ(account.tick(asks(0.1, bit(Guard::ramp))), ForceOutcome::start);
    for (const auto& [guard, outcome] :
         {std::pair{Guard::notANumber, ForceOutcome::notANumber}, std::pair{Guard::stale, ForceOutcome::stale},
          std::pair{Guard::missed, ForceOutcome::missed}, std::pair{Guard::lost, ForceOutcome::lost},
          std::pair{Guard::jumped, ForceOutcome::jumped}, std::pair{Guard::tripped, ForceOutcome::tripped}}) {
        EXPECT_EQ(account.tick(asks(0, bit(guard))), outcome);
        EXPECT_EQ(account.tick(asks(0.1, bit(Guard::ramp) | bit(Guard::slew))), outcome);
    }
    account.forget();
    EXPECT_EQ(account.tick(asks(0.1, bit(Guard::ramp))), ForceOutcome::start) << "another link";
    // The ramp of half a second after force was switched on.
    auto off = asks(0);
    off.share = 0;
    EXPECT_EQ(account.tick(off), ForceOutcome::off);
    auto later = asks(0.3);
    later.time += 0.3;
    EXPECT_EQ(account.tick(later), ForceOutcome::off);
    later.time += 0.3;
    EXPECT_EQ(account.tick(later), ForceOutcome::damped) << "the ramp is over";
}

TEST(ForceAccount, NamesWhySandHasStoppedUntilTheForceIsBack) {
    ForceAccount account;
    for (const ForceOutcome cause : {ForceOutcome::pause, ForceOutcome::disk, ForceOutcome::steps,
                                     ForceOutcome::slowMotion, ForceOutcome::start}) {
        auto stopped = asks(0, bit(Guard::frozen));
        stopped.stopped = cause;
        EXPECT_EQ(account.tick(stopped), cause);
        EXPECT_EQ(account.tick(asks(0.2, bit(Guard::frozen) | bit(Guard::ramp))), cause) << "steps come again";
        account.forget();
    }
}

TEST(ForceAccount, TakesAMomentForTheFirstStepsAfterAPause) {
    ForceAccount account;
    auto stopped = asks(0, bit(Guard::frozen));
    stopped.stopped = ForceOutcome::pause;
    EXPECT_EQ(account.tick(stopped), ForceOutcome::pause);
    stopped.stopped = ForceOutcome::steps;
    for (const auto& [later, cause] : {std::pair{0.9, ForceOutcome::pause}, std::pair{1.1, ForceOutcome::steps}}) {
        auto next = stopped;
        next.time += later;
        EXPECT_EQ(account.tick(next), cause) << later;
    }
}

TEST(ForceAccount, NamesWhatTheGuardsTake) {
    ForceAccount account;
    for (const Guard guard : {Guard::contact, Guard::gate, Guard::slew}) {
        EXPECT_EQ(account.tick(asks(0.2, bit(guard) | bit(Guard::passivity))), ForceOutcome::growth);
    }
    EXPECT_EQ(account.tick(asks(0.2, bit(Guard::passivity))), ForceOutcome::damped);
    EXPECT_EQ(account.tick(asks(0.2, bit(Guard::unread))), ForceOutcome::lost);
}

TEST(ForceAccount, TakesTheForceOfTheLastReadingWhereThereIsNone) {
    ForceAccount account;
    ForceAccount::Tick none{.time = 1, .asked = std::nullopt, .acted = bit(Guard::lost)};
    EXPECT_EQ(account.tick(none), std::nullopt) << "the law has asked for no force yet";
    (void)account.tick(asks(1));
    EXPECT_EQ(account.tick(none), ForceOutcome::lost);
    none.asked = kNan;
    none.acted = bit(Guard::notANumber);
    EXPECT_EQ(account.tick(none), ForceOutcome::notANumber);
    (void)account.tick({.time = 2, .asked = 0, .sent = 0});
    EXPECT_EQ(account.tick(none), std::nullopt) << "the hand was above the sand";
}

TEST(HandTicks, CountASecondWithAFaultOnce) {
    HandTicks ticks;
    for (int tick = 0; tick < 10'000; ++tick) {
        const bool fault = tick == 1'000 || tick == 1'004 || tick == 1'999 || tick == 5'500;
        ticks.add(tick * 1e-3, fault ? bit(Guard::missed) : bit(Guard::ramp), !fault,
                  fault ? ForceOutcome::missed : ForceOutcome::half);
    }
    EXPECT_EQ(ticks.seconds(), 10U);
    EXPECT_EQ(ticks.faultedSeconds(), 2U) << "the second and the sixth";
    EXPECT_EQ(ticks.faulted(), 4U);
    EXPECT_EQ(ticks.asked()[static_cast<std::size_t>(ForceOutcome::missed)], 4U);
    EXPECT_EQ(ticks.asked()[static_cast<std::size_t>(ForceOutcome::half)], 9'996U);
}

}  // namespace
