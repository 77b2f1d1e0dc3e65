// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/loop/guards/guards.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "haptic_bridge/devices/strokes.hpp"
#include "haptic_bridge/hand/arm_presets.hpp"
#include "haptic_bridge/loop/guards/limited_law.hpp"
#include "haptic_bridge/loop/guards/velocity_window.hpp"
#include "haptic_bridge/loop/haptic_tick.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/hand/arm_loop.hpp"
#include "tests/support/hand/arm_on_sand.hpp"

namespace {

using namespace haptic_bridge;
using sand::force::Response;
using sand::force::Vec3;
using test::kTick;

ForceLimits touchLimits() { return ForceLimits::of(touchPreset(), test::kScale, {500, 50, 5}, 0.67); }

TEST(VelocityWindow, HearsAFastHandAtOnceAndASlowOneWithoutNoise) {
    constexpr double kStep = 55e-6;
    const auto encoded = [](double x) { return std::floor(x / kStep + 0.5) * kStep; };
    VelocityWindow window(kStep);
    double worst = 0;
    for (int tick = 0; tick < 500; ++tick) {
        const double slow = window.add(tick * kTick, {encoded(0.004 * tick * kTick), 0, 0}).x;
        worst = tick > 20 ? std::max(worst, std::abs(slow - 0.004)) : worst;
    }
    EXPECT_LT(worst, kStep / (VelocityWindow::kLongest * kTick)) << "a difference over one tick is wrong by 51 mm/s";
    const double before = 0.004 * 499 * kTick;
    Vec3 now;
    for (int tick = 500; tick < 503; ++tick) {
        now = window.add(tick * kTick, {encoded(before + 1.0 * (tick - 499) * kTick), 0, 0});
    }
    EXPECT_NEAR(now.x, 1, 0.1) << "three ticks after a jump in speed";
}

TEST(VelocityWindow, IsADifferenceOverOneTickWithoutAResolutionAndExactOnALine) {
    VelocityWindow window(0);
    EXPECT_EQ(norm(window.add(0, {1, 2, 3})), 0);
    EXPECT_NEAR(window.add(0.001, {1.001, 2, 3}).x, 1, 1e-9);
    EXPECT_NEAR(window.add(0.002, {1.000, 2, 3}).x, -1, 1e-9);
    EXPECT_EQ(norm(window.add(0.002, {5, 2, 3})), 0) << "the velocity is 0 while the clock does not advance";
    EXPECT_EQ(norm(window.add(0.001, {5, 9, 3})), 0) << "the velocity is 0 if the clock runs backwards";
}

TEST(ForceLimits, AreHalfOfWhatTheArmBearsInWords) {
    const scene::Scene scene = test::levelSand();
    const LawAtRadius law = lawAtRadius(scene);
    EXPECT_NEAR(law.stiffness, 500 * std::exp(0.005), 1);
    EXPECT_NEAR(law.push, 5.0125, 0.01);
    const ForceLimits limits = ForceLimits::of(touchPreset(), test::kScale, law, 0.67);
    EXPECT_NEAR(limits.stiffness, 0.35 / 1.5e-3 / 2, 1e-9);
    EXPECT_NEAR(limits.gain * 1000, 18.6, 0.1);
    EXPECT_NEAR(limits.lawStiffness, limits.stiffness, 1e-9);
    const auto words = limits.inWords("k_s", 1000, law);
    EXPECT_EQ(words[0],
              "k_s 1000 → 19: touch at 12.5 scene units per metre; the law asks for 6281 N/m, the limit is 117 N/m, "
              "half of what "
              "0.35 N s/m of damping and 1 tick of delay allow");
    ArmPhysics stiff = touchPreset();
    stiff.damping = 5;
    EXPECT_NEAR(ForceLimits::of(stiff, test::kScale, law, 0.67).stiffness, 200, 1e-9)
        << "half of what the maker allows";
    const LawAtRadius soft{5, 0.5, 0.05};
    const ForceLimits free = ForceLimits::of(touchPreset(), test::kScale, soft, 0.67);
    EXPECT_EQ(free.gain, 1);
    EXPECT_EQ(free.inWords("k_s", 10, soft)[0].substr(0, 17), "k_s 10 as it is: ");
}

TEST(ForceLimits, NameTheConstantOfTheSceneLaw) {
    const auto words = [](sand::ForceLaw law) {
        scene::Scene scene = test::levelSand();
        scene.force.law = law;
        auto strokes = std::make_unique<StrokeDevice>(Strokes::parse(gisStrokes(), "gis.strokes"));
        return HapticTick(scene, std::move(strokes), HandSettings::Datum::surface).limitsInWords().front();
    };
    EXPECT_EQ(words(sand::ForceLaw::repulse).substr(0, 9), "k_s 1000 ");
    EXPECT_EQ(words(sand::ForceLaw::controlPoints).substr(0, 7), "F_M 10 ");
}

TEST(ForceLimits, BearLessWhereAnEncodersStepWouldChatter) {
    ArmPhysics arm = *armPreset("delta.3");
    arm.damping = 5;
    arm.delayTicks = 0;
    const LawAtRadius law{500, 50, 5};
    const double fine = ForceLimits::of(arm, test::kScale, law, 0.67).stiffness;
    EXPECT_LT(fine, 2500) << "half of the sampled limit is 5000";
    arm.resolution = 0;
    EXPECT_EQ(ForceLimits::of(arm, test::kScale, law, 0.67).stiffness, 5000);
    arm.resolution = 20e-6;
    arm.friction = 0.1;
    EXPECT_EQ(ForceLimits::of(arm, test::kScale, law, 0.67).stiffness, 5000) << "the arm's friction holds the weight";
}

TEST(LimitedLaw, LeavesWhatIsWithinTheLimits) {
    std::uint32_t acted = 0;
    ForceLimits limits = touchLimits();
    limits.gain = 1;
    const Response soft{{0.1, 0, 0.2}, {0, 0, 1}, 0.5, 5};
    const Vec3 velocity{0.01, 0.02, 0.5};
    const Vec3 force = limitedForce(soft, velocity, limits, acted), law = lawfulForce(soft, velocity, test::kScale);
    EXPECT_EQ(acted, 0U);
    EXPECT_LT(norm(force - law), 0.05 * norm(law));
    EXPECT_NEAR(law.y, -0.5 * 0.02 * test::kScale / 60, 1e-12)
        << "per frame of 1/60 s, and no friction along the normal";
    EXPECT_NEAR(law.z, 0.2, 1e-12);
}

TEST(LimitedLaw, BoundsStiffnessAndFriction) {
    const ForceLimits limits = touchLimits();
    std::uint32_t acted = 0;
    const Response papers{{0, 0, 5}, {0, 0, 1}, 50, 500};
    EXPECT_NEAR(limitedForce(papers, {}, limits, acted).z, 5 * limits.gain, 1e-12);
    EXPECT_EQ(acted, bit(Guard::stiffness));
    const Response stiffer{{0, 0, 5}, {0, 0, 1}, 50, 1000};
    EXPECT_NEAR(limitedForce(stiffer, {}, limits, acted).z, 5 * limits.gain / 2, 1e-12) << "never stiffer than K";

    acted = 0;
    const double pressed = 5 * limits.gain;
    const Vec3 fast = limitedForce(papers, {3, 0, 0}, limits, acted);
    EXPECT_NEAR(fast.x, -0.67 * pressed, 1e-12) << "sand holds no more than the tangent of its talus";
    EXPECT_NE(acted & bit(Guard::friction), 0U);
    acted = 0;
    const Response sticky{{0, 0, 1000}, {0, 0, 1}, 1e6, 100};
    EXPECT_NEAR(limitedForce(sticky, {0.1, 0, 0}, limits, acted).x, -0.1 * limits.damping, 1e-12);
    EXPECT_NE(acted & bit(Guard::damping), 0U);
}

TEST(Slew, BoundsWhatGrowsOrTurnsAndLetsGo) {
    Slew slew(0.1);
    std::uint32_t acted = 0;
    EXPECT_NEAR(slew.follow({0, 0, 1}, acted).z, 0.1, 1e-12);
    EXPECT_EQ(acted, bit(Guard::slew));
    for (int tick = 0; tick < 20; ++tick) {
        (void)slew.follow({0, 0, 1}, acted);
    }
    acted = 0;
    EXPECT_EQ(slew.follow({0, 0, 0.2}, acted).z, 0.2) << "a falling force is not held back";
    EXPECT_EQ(slew.follow({}, acted).z, 0);
    EXPECT_EQ(acted, 0U);
    (void)slew.follow({0, 0, 0.1}, acted);
    EXPECT_NEAR(slew.follow({0, 0, -1}, acted).z, -0.1, 1e-12) << "a force that reverses begins at 0";
}

/// A spring so stiff that sampling makes it gain energy, without limits: the energy that the observer sees, and the
/// effect of its damping.
struct Leak {
    double observed = 0, exact = 0, energy = 0;
};
Leak runLeakingSpring(double stiffness, bool controlled) {
    const ArmPhysics arm = test::textbookArm(0.5);
    ForceLimits limits = ForceLimits::of(arm, 1, {}, 0);
    limits.lawStiffness = stiffness;
    PassivityObserver observer(limits);
    SimulatedArm body(arm);
    body.start({}, {0.01, 0, 0});
    Leak leak;
    double before = 0;
    for (int tick = 0; tick < 3000; ++tick) {
        const double x = body.read(tick * kTick).place.x;
        const Vec3 velocity = body.velocity();
        observer.observe({x, 0, 0}, kTick);
        leak.exact += stiffness / 2 * (x - before) * (x - before);
        leak.observed = observer.returned() + stiffness / 2 * x * x;
        before = x;
        std::uint32_t acted = 0;
        const Vec3 damping = controlled ? observer.control(velocity, acted) : Vec3{};
        const Vec3 force = Vec3{-stiffness * x, 0, 0} + damping;
        observer.sent(force);
        body.push(force);
    }
    leak.energy = body.kineticEnergy() + stiffness / 2 * before * before;
    return leak;
}

TEST(PassivityObserver, SeesWhatASampledSpringLeaksAndCutsIt) {
    constexpr double kLimit = 2 * 0.5 / kTick;
    const Leak free = runLeakingSpring(1.1 * kLimit, false), damped = runLeakingSpring(1.1 * kLimit, true);
    EXPECT_NEAR(free.observed, free.exact, 1e-9 * free.exact) << "K/2 Δx² every tick";
    constexpr double kStart = 0.05 / 2 * 0.01 * 0.01;
    EXPECT_GT(free.energy, 1.3 * kStart) << "the loop diverges";
    EXPECT_LT(damped.energy, kStart) << "the observer's damping keeps the loop stable";
}

TEST(PassivityObserver, LeavesAStableSpringAlone) {
    const ArmPhysics arm = test::textbookArm(0.5);
    ForceLimits limits = ForceLimits::of(arm, 1, {}, 0);
    limits.lawStiffness = limits.stiffness;
    PassivityObserver observer(limits);
    SimulatedArm body(arm);
    body.start({}, {0.1, 0, 0});
    std::uint32_t acted = 0;
    for (int tick = 0; tick < 3000; ++tick) {
        const Vec3 at = body.read(tick * kTick).place;
        observer.observe(at, kTick);
        (void)observer.control(body.velocity(), acted);
        const Vec3 force = -limits.stiffness * at;
        observer.sent(force);
        body.push(force);
    }
    EXPECT_EQ(acted, 0U);
}

/// Guards whose ramp is over, and the reading of a hand that rests in the sand.
struct Resting {
    Guards guards{touchLimits()};
    Guards::Reading reading;
    Guards::Forces last;

    Resting() {
        reading.engaged = true;
        reading.felt = {{0, 0, 5}, {0, 0, 1}, 50, 500};
        for (int tick = 0; tick < 2500; ++tick) {
            next();
        }
    }
    const Guards::Forces& next(double span = kTick) {
        reading.time += span;
        last = guards.tick(reading);
        return last;
    }
};

TEST(Guards, RampTheFirstTwoSeconds) {
    Guards guards(touchLimits());
    Guards::Reading reading;
    reading.engaged = true;
    reading.felt = {{0, 0, 5}, {0, 0, 1}, 50, 500};
    const double whole = 5 * touchLimits().gain;
    double before = 0;
    for (int tick = 0; tick < 2200; ++tick) {
        reading.time = tick * kTick;
        const Guards::Forces forces = guards.tick(reading);
        ASSERT_LE(forces.sent.z - before, whole * kTick / 2 * 1.001) << "no step above the ramp, tick " << tick;
        ASSERT_EQ((forces.acted & bit(Guard::ramp)) != 0, tick < 2000) << tick;
        before = forces.sent.z;
    }
    EXPECT_NEAR(before, whole, 1e-9);
}

/// `hurt` makes one reading bad. The guard `guard` must set the force to 0 within that tick, and the ramp follows.
template <class Hurt>
void expectSilence(Guard guard, const Hurt& hurt) {
    Resting hand;
    const double whole = hand.last.sent.z;
    ASSERT_GT(whole, 0.05);
    const Guards::Reading good = hand.reading;
    double span = kTick;
    hurt(hand.reading, span);
    const Guards::Forces& bad = hand.next(span);
    EXPECT_EQ(norm(bad.sent), 0) << base::nameOf(guard);
    EXPECT_NE(bad.acted & bit(guard), 0U) << base::nameOf(guard);
    const double time = hand.reading.time;
    hand.reading = good;
    hand.reading.time = time;
    hand.next();
    EXPECT_LE(hand.last.sent.z, whole * 1e-3) << "the force comes back in the ramp";
    for (int tick = 0; tick < 2100; ++tick) {
        hand.next();
    }
    EXPECT_NEAR(hand.last.sent.z, whole, 1e-9) << base::nameOf(guard);
}

TEST(Guards, SendNothingWithinATickOfAFaultAndRampAfterIt) {
    const double none = std::numeric_limits<double>::quiet_NaN(), most = std::numeric_limits<double>::infinity();
    expectSilence(Guard::notANumber, [&](Guards::Reading& r, double&) { r.felt.push.x = none; });
    expectSilence(Guard::notANumber, [&](Guards::Reading& r, double&) { r.felt.push.z = most; });
    expectSilence(Guard::notANumber, [&](Guards::Reading& r, double&) { r.place.y = none; });
    expectSilence(Guard::notANumber, [&](Guards::Reading& r, double&) { r.velocity.y = -most; });
    expectSilence(Guard::notANumber, [&](Guards::Reading& r, double&) { r.felt.stiffness = none; });
    expectSilence(Guard::stale, [](Guards::Reading& r, double&) { r.surfaceAge = 0.0501; });
    expectSilence(Guard::stale, [&](Guards::Reading& r, double&) { r.surfaceAge = none; });
    expectSilence(Guard::missed, [](Guards::Reading&, double& span) { span = 0.0101; });
    expectSilence(Guard::missed, [](Guards::Reading&, double& span) { span = -0.5; });
    expectSilence(Guard::lost, [](Guards::Reading& r, double&) { r.present = false; });
    expectSilence(Guard::jumped, [](Guards::Reading& r, double&) { r.place.x = 1; });
}

TEST(Guards, ClampByTheNorm) {
    ForceLimits limits = touchLimits();
    limits.gain = 1;
    limits.stiffness = limits.slew = 1e9;
    Guards guards(limits);
    Guards::Reading reading;
    reading.engaged = true;
    reading.felt = {{30, 0, 40}, {0.6, 0, 0.8}, 0, 1};
    Guards::Forces forces;
    for (int tick = 0; tick < 2100; ++tick) {
        reading.time = tick * kTick;
        forces = guards.tick(reading);
        ASSERT_LE(norm(forces.sent), 3.3 + 1e-12);
    }
    EXPECT_NEAR(norm(forces.sent), 3.3, 1e-12);
    EXPECT_NEAR(forces.sent.x / forces.sent.z, 0.75, 1e-12);
    EXPECT_NE(forces.acted & bit(Guard::clamp), 0U);
}

TEST(Guards, ForgettingIsBeingNew) {
    const auto forces = [](Guards& guards, double from) {
        std::vector<Vec3> sent;
        for (int tick = 0; tick < 3000; ++tick) {
            Guards::Reading reading;
            reading.time = from + tick * kTick;
            reading.engaged = true;
            reading.place = {0, 0, 0.0005 * std::sin(0.3 * tick)};
            reading.velocity = {0.02, 0, 0.15 * std::cos(0.3 * tick)};
            reading.felt.push = {0, 0, 100};  // several ticks of slew
            reading.felt.stiffness = 500;
            reading.felt.drag = 2;
            sent.push_back(guards.tick(reading).sent);
        }
        return sent;
    };
    Guards guards(touchLimits());
    const std::vector<Vec3> first = forces(guards, 0);
    guards.forget();
    const std::vector<Vec3> again = forces(guards, 0);
    EXPECT_GT(norm(first.back()), 0);
    for (std::size_t tick = 0; tick < first.size(); ++tick) {
        ASSERT_EQ(norm(again[tick] - first[tick]), 0) << "tick " << tick;
    }
}

TEST(Guards, LiterallyAreThePapersLaw) {
    Guards guards(touchLimits(), Guards::Mode::literal);
    Guards::Reading reading;
    reading.engaged = true;
    reading.felt = {{0, 0, 50}, {0, 0, 1}, 500, 5000};
    reading.velocity = {0.1, 0, 0};
    const Guards::Forces forces = guards.tick(reading);
    EXPECT_EQ(forces.sent.z, 50);
    EXPECT_NEAR(forces.sent.x, -500 * 0.1 * test::kScale / 60, 1e-12);
    EXPECT_EQ(forces.acted, 0U);
    reading.felt.push.z = std::nan("");
    EXPECT_EQ(norm(guards.tick(reading).sent), 0);
}

TEST(GuardCounts, CountEachGuardForItself) {
    GuardCounts counts;
    counts.add(bit(Guard::clamp) | bit(Guard::slew));
    counts.add(bit(Guard::clamp));
    counts.add(0);
    EXPECT_EQ(counts.all()[static_cast<std::size_t>(Guard::clamp)], 2U);
    EXPECT_EQ(counts.all()[static_cast<std::size_t>(Guard::slew)], 1U);
    EXPECT_EQ(counts.all()[static_cast<std::size_t>(Guard::lost)], 0U);
}

}  // namespace
