// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/devices/simulated_arm.hpp"

#include <gtest/gtest.h>

#include <array>

#include "base/input_error.hpp"
#include "haptic_bridge/hand/arm_presets.hpp"
#include "host/clock.hpp"
#include "tests/support/hand/arm_loop.hpp"

namespace {

using namespace haptic_bridge;
using sand::force::Vec3;
using test::growth;
using test::kTick;
using test::textbookArm;

constexpr double kPapersScale = 12.5;  // [scene unit/m]

auto spring(double stiffness) {
    return [stiffness](double x) { return -stiffness * x; };
}

/// A damper that sees only places. It uses the difference over `window` ticks.
auto damper(double damping, int window) {
    return [=, places = std::array<double, 16>{}, count = 0](double x) mutable {
        places[static_cast<std::size_t>(count % 16)] = x;
        const int span = std::min(count, window);
        const double before = places[static_cast<std::size_t>((count - span) % 16)];
        ++count;
        return span > 0 ? -damping * (x - before) / (span * kTick) : 0.0;
    };
}

TEST(SimulatedArm, DecaysFreelyAsItsEquationDoes) {
    for (const double damping : {0.0, 0.5, 5.0}) {
        SimulatedArm arm(textbookArm(damping));
        arm.start({}, {1, 0, 0});
        for (int tick = 0; tick < 3000; ++tick) {
            (void)arm.read(tick * kTick);
            ASSERT_NEAR(arm.velocity().x, std::exp(-damping * tick * kTick / 0.05), 1e-12) << "tick " << tick;
        }
    }
}

TEST(SimulatedArm, MovesTheSameHoweverTimeIsCut) {
    // The arm has held forces, a hand, friction and a delay. It moves the same if it is read every tick or at odd times
    // in between.
    ArmPhysics physics = touchPreset();
    physics.resolution = 0;
    const auto path = [](double time) { return SimulatedArm::Target{{0.02 * time, 0.01, -0.005}, true}; };
    SimulatedArm coarse(physics, {300, 5}, path), fine(physics, {300, 5}, path);
    for (int tick = 0; tick < 300; ++tick) {
        const Vec3 force{0.5 * std::sin(tick * 0.1), 0, tick % 7 == 0 ? 1.0 : 0.2};
        (void)coarse.read(tick * kTick);
        (void)fine.read(tick * kTick);
        coarse.push(force);
        fine.push(force);
        // A stop and a start within a quarter of a tick may be missed. Only there may the two differ.
        ASSERT_NEAR(norm(coarse.place() - fine.place()), 0, 1e-7) << "tick " << tick;
        for (const double share : {0.25, 0.5}) {
            (void)fine.read((tick + share) * kTick);
        }
    }
}

TEST(SimulatedArm, HoldsFastUntilMoreThanItsFrictionPulls) {
    ArmPhysics physics = textbookArm(0.35, 0, 0.045);
    physics.friction = 0.26;
    SimulatedArm arm(physics);
    (void)arm.read(0);
    arm.load({0.25, 0, 0});
    (void)arm.read(1);
    EXPECT_EQ(arm.place().x, 0);
    arm.load({0.36, 0, 0});
    (void)arm.read(3);
    EXPECT_NEAR(arm.velocity().x, 0.1 / 0.35, 1e-6) << "the force above friction, against the damping";
    arm.load({});
    arm.start({}, {0.1, 0, 0});
    (void)arm.read(4);
    EXPECT_EQ(arm.velocity().x, 0) << "friction stops the arm and does not reverse it";
    // m v' + b v + F = 0 from v: the way to the stop is (m/b)(v − (F/b) ln(1 + b v/F)).
    EXPECT_NEAR(arm.place().x, 0.045 / 0.35 * (0.1 - 0.26 / 0.35 * std::log1p(0.35 * 0.1 / 0.26)), 1e-12);
}

TEST(SimulatedArm, RoundsSaturatesDelaysAndStopsAtItsReach) {
    ArmPhysics physics = touchPreset();
    physics.friction = 0;
    SimulatedArm arm(physics);
    arm.start({1.3e-4, 0, 0}, {});
    EXPECT_NEAR(arm.read(0).place.x, 2 * 55e-6, 1e-15) << "the nearest step of the encoder";
    arm.push({30, 0, 40});
    (void)arm.read(0.001);
    EXPECT_EQ(norm(arm.velocity()), 0) << "a tick of delay";
    (void)arm.read(0.002);
    EXPECT_NEAR(norm(arm.velocity()), 3.3 / 0.045 * 1e-3, 1e-3) << "the motor gives 3.3 N";
    EXPECT_NEAR(arm.velocity().x / arm.velocity().z, 0.75, 1e-9);
    (void)arm.read(5);
    EXPECT_EQ(arm.place().z, physics.reach);
    EXPECT_EQ(norm(arm.velocity()), 0);
    arm.push({std::nan(""), 0, 0});
    (void)arm.read(5.1);
    EXPECT_EQ(norm(arm.velocity()), 0);
}

TEST(SimulatedArm, IsHeldByAHandThatFollowsItsPath) {
    ArmPhysics physics = touchPreset();
    physics.friction = 0;
    const auto path = [](double time) { return SimulatedArm::Target{{0.05 * time, 0, -0.01}, true}; };
    SimulatedArm arm(physics, {300, 5}, path);
    (void)arm.read(0);
    EXPECT_EQ(arm.place().z, -0.01) << "the arm starts at the start of the path";
    for (int tick = 1; tick <= 1000; ++tick) {
        (void)arm.read(tick * kTick);
    }
    EXPECT_NEAR(arm.velocity().x, 0.05, 1e-9);
    EXPECT_NEAR(arm.place().x, 0.05 - 0.35 * 0.05 / 300, 1e-9)
        << "the arm lags by its damping force over the hand's stiffness";
}

TEST(SimulatedArm, RunsOnTheHostsClockAsOnAVirtualOne) {
    SimulatedArm real(textbookArm(0.5)), virtually(textbookArm(0.5));
    const std::int64_t begin = host::monotonicNs();
    for (SimulatedArm* arm : {&real, &virtually}) {
        (void)arm->read(0);
        arm->start({}, {1, 0, 0});
    }
    double time = 0;
    for (int tick = 0; tick < 50; ++tick) {
        time = static_cast<double>(host::monotonicNs() - begin) * 1e-9;
        (void)real.read(time);
    }
    (void)virtually.read(time);
    EXPECT_NEAR(real.place().x, virtually.place().x, 1e-12);
}

// A sampled spring is stable while b > K (T/2 + t_d).
TEST(SampledLoop, WallSettlesBelowTwiceItsDampingOverTheTick) {
    for (const double damping : {0.5, 1.0, 2.0, 5.0}) {
        EXPECT_LT(growth(textbookArm(damping), spring(0.95 * 2 * damping / kTick)), 1) << damping;
        EXPECT_GT(growth(textbookArm(damping), spring(1.05 * 2 * damping / kTick)), 1) << damping;
    }
}

TEST(SampledLoop, WallOneTickLateBearsAThird) {
    for (const double damping : {0.5, 1.0, 2.0, 5.0}) {
        EXPECT_LT(growth(textbookArm(damping, 1), spring(0.95 * damping / (1.5 * kTick))), 1) << damping;
        EXPECT_GT(growth(textbookArm(damping, 1), spring(1.05 * damping / (1.5 * kTick))), 1) << damping;
    }
}

TEST(SampledLoop, DamperBearsTwiceTheMassOverTheTickAndASixthOfThatWithAWindow) {
    EXPECT_LT(growth(textbookArm(0.5), damper(95, 1)), 1);
    EXPECT_GT(growth(textbookArm(0.5), damper(105, 1)), 1);
    EXPECT_LT(growth(textbookArm(0.5), damper(14, 15)), 1);
    EXPECT_GT(growth(textbookArm(0.5), damper(17, 15)), 1);
    EXPECT_LT(growth(textbookArm(0.5, 1), damper(40, 1)), 1) << "42 with a tick of delay";
    EXPECT_GT(growth(textbookArm(0.5, 1), damper(44, 1)), 1);
}

/// Returns the largest speed of an arm after about three seconds. It is pressed into the sand of Dorjgotov et al. 2007
/// with the force of a depth of one radius.
double lastSpeedInSeedSand(double damping) {
    SimulatedArm arm(textbookArm(damping));
    arm.start({0, 0, -0.01 / kPapersScale}, {0, 0, 0.05});
    arm.load({0, 0, -1000 * std::expm1(0.5 * 0.01)});
    double last = 0;
    for (int tick = 0; tick < 3000; ++tick) {
        const double depth = std::max(0.0, -arm.read(tick * kTick).place.z * kPapersScale);
        arm.push({0, 0, 1000 * std::expm1(0.5 * depth)});
        last = tick >= 2800 ? std::max(last, std::abs(arm.velocity().z)) : last;
    }
    return last;
}

TEST(SampledLoop, SeedSpringCyclesBelowAndSettlesAbove3125MillinewtonsPerMetreAndSecond) {
    EXPECT_GT(lastSpeedInSeedSand(2.9), 0.3) << "the arm leaves the sand and falls back without end";
    EXPECT_LT(lastSpeedInSeedSand(3.3), 1e-3);
}

TEST(SampledLoop, SeedFrictionDivergesFromASixthOfARadiusOn) {
    // k_f = 10 per unit/s, as printed: B = k_f |F_r| · 12.5, against the limit 2m/T = 100.
    const auto friction = [](double depth) { return damper(10 * 1000 * std::expm1(0.5 * depth) * kPapersScale, 1); };
    EXPECT_LT(growth(textbookArm(0.5), friction(1.4e-3)), 1);
    EXPECT_GT(growth(textbookArm(0.5), friction(2.0e-3)), 1);
}

/// A spring that is evaluated once per frame of 1/60 s. Between frames its force is held or interpolated.
auto frameSpring(double stiffness, bool interpolated) {
    return [=, tick = 0, frame = -1, begun = 0, from = 0.0, to = 0.0](double x) mutable {
        constexpr double kTicksPerFrame = 1000.0 / 60;
        const int now = static_cast<int>(tick / kTicksPerFrame);
        if (now != frame) {
            frame = now;
            begun = tick;
            from = to;
            to = -stiffness * x;
        }
        const double share = interpolated ? std::min((tick - begun + 1) / kTicksPerFrame, 1.0) : 1.0;
        ++tick;
        return from + (to - from) * share;
    };
}

TEST(SampledLoop, InterpolationBetweenFramesBearsHalfOfWhatHoldingDoesAndALocalModelSixteenTimesThat) {
    EXPECT_LT(growth(textbookArm(0.5), frameSpring(28, true), 6), 1);
    EXPECT_GT(growth(textbookArm(0.5), frameSpring(35, true), 6), 1);
    EXPECT_LT(growth(textbookArm(0.5), frameSpring(58, false), 6), 1);
    EXPECT_GT(growth(textbookArm(0.5), frameSpring(66, false), 6), 1);
    // On level sand the force and Jacobian of the last surface are the spring itself, evaluated at every tick.
    EXPECT_LT(growth(textbookArm(0.5), spring(950), 6), 1);
}

std::string complaint(const std::string& spec) {
    try {
        (void)openSimulatedArm(spec);
    } catch (const base::InputError& error) {
        return error.what();
    }
    return "(no error)";
}

TEST(OpenSimulatedArm, ReadsPresetsAndWhatIsChangedOfThem) {
    EXPECT_EQ(openSimulatedArm("sim:omega.3")->physics().maxForce, 12);
    EXPECT_EQ(openSimulatedArm("touch")->physics().delayTicks, 1);
    const auto arm = openSimulatedArm("sim:falcon,damping=2.5,delay=0,path=gis,grip=200,grip_damping=3");
    EXPECT_EQ(arm->physics().damping, 2.5);
    EXPECT_EQ(arm->physics().delayTicks, 0);
    EXPECT_EQ(arm->physics().mass, 0.13);
    (void)arm->read(0);
    EXPECT_GT(arm->place().z, 0) << "the hand begins above the sand";
}

TEST(OpenSimulatedArm, NamesWhatItCannotRead) {
    const auto starts = [](const std::string& spec, const std::string& start) {
        EXPECT_EQ(complaint(spec).substr(0, start.size()), start) << complaint(spec);
    };
    starts("sim:", "--device sim:: preset '' is unknown; give touch");
    starts("sim:phantom", "--device sim:phantom: preset 'phantom' is unknown; give touch, falcon, omega.3 or delta.3");
    starts("sim:touch,mass=0", "--device sim:touch,mass=0: mass needs 0.005 to 10 kg, got '0'");
    starts("sim:touch,mass=nan", "--device sim:touch,mass=nan: mass needs 0.005 to 10 kg, got 'nan'");
    starts("sim:touch,damping=-1", "--device sim:touch,damping=-1: damping needs more than 0 and at most 100 N s/m");
    starts("sim:touch,delay=0.5", "--device sim:touch,delay=0.5: delay must be a whole number of ticks");
    starts("sim:touch,colour=red", "--device sim:touch,colour=red: key 'colour' is unknown");
    starts("sim:touch,", "--device sim:touch,: key '' is unknown; the keys are path");
    starts("sim:touch,path=/nowhere", "--device sim:touch,path=/nowhere: /nowhere cannot be read");
}

}  // namespace
