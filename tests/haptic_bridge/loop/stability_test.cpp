// SPDX-License-Identifier: Apache-2.0
// Whole hands on level sand under a virtual clock: the constants of Dorjgotov et al. 2007, as the guards limit them, on
// real arms.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "sand/replica.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/hand/arm_loop.hpp"
#include "tests/support/hand/arm_on_sand.hpp"
#include "tests/support/sand/sand_of.hpp"
#include "tests/support/seed.hpp"

namespace {

using namespace haptic_bridge;
using sand::force::Vec3;
using test::ArmSession;
using test::kTick;
using test::Outcome;
using test::Trial;

constexpr double kPapersTouch = test::kPapersRadius;  // [scene unit], height of the centre at the first touch

const scene::Scene& papersSand() {
    static const scene::Scene scene = test::levelSand();
    return scene;
}

/// The corners of the sweep that `sandwall-bench guarded-sweep` does in full.
TEST(GuardedLoop, RestsOnEveryArmWithThePapersConstantsWhereTheLiteralOneDoesNot) {
    long touching = 0, unlimited = 0;
    int diverged = 0, trials = 0;
    for (const std::string_view name : kArmPresets) {
        for (const double damping : {0.5, 5.0}) {
            for (const int delay : {0, 1}) {
                for (const auto& [depth, speed] : {std::pair{0.0, 1.0}, {1.0, 0.0}, {3.0, 0.3}}) {
                    for (const bool held : {false, true}) {
                        Trial trial{*armPreset(name), depth, speed, held};
                        trial.arm.damping = damping;
                        trial.arm.delayTicks = delay;
                        SCOPED_TRACE(fmt::format("{}, {} N s/m, delay {}, {} radii, {} m/s, {}", name, damping, delay,
                                                 depth, speed, held ? "held" : "pressed"));
                        const Outcome guarded = run(trial, papersSand());
                        EXPECT_LT(guarded.lastSpeed, 1e-3) << "after " << guarded.allowed << " s";
                        EXPECT_LE(guarded.mostForce, trial.arm.maxForce * (1 + 1e-12));
                        EXPECT_LE(guarded.deviation, 0.05);
                        touching += guarded.touching;
                        unlimited += guarded.unlimited;
                        ++trials;
                        if (damping == 0.5 && delay == 1 && depth == 3 && !held) {
                            trial.mode = Guards::Mode::literal;
                            EXPECT_FALSE(run(trial, papersSand()).settles()) << "without guards";
                            ++diverged;
                        }
                    }
                }
            }
        }
    }
    // A loop that sends no force would also rest.
    EXPECT_GT(unlimited, touching * 9 / 10) << touching;
    std::printf("%d trials, %ld ticks in the sand, %ld of them unlimited; %d literal ones diverged\n", trials, touching,
                unlimited, diverged);
}

TEST(GuardedLoop, IsTheLiteralOneWhereNothingLimitsIt) {
    // A hundredth of the stiffness of Dorjgotov et al. 2007 is 62 N/m. A Touch can bear 117 N/m.
    sand::ForceConstants soft;
    soft.stiffness = 10;
    const scene::Scene scene = test::levelSand(soft);
    const auto path = test::toAndFro(0.003, 0.1, 2.01);
    ArmSession guarded(scene, std::make_unique<SimulatedArm>(touchPreset(), Grip{300, 5}, path));
    ArmSession literal(scene, std::make_unique<SimulatedArm>(touchPreset(), Grip{300, 5}, path), Guards::Mode::literal);
    guarded.warmUp();
    literal.warmUp();
    double most = 0;
    for (int tick = 0; tick < 1000; ++tick) {
        const Tick& here = guarded.tick();
        const Tick& there = literal.tick();
        EXPECT_LE(norm(here.sent - there.sent), 0.05 * norm(there.sent) + 1e-9) << "tick " << tick;
        EXPECT_EQ(here.guards & ~bit(Guard::slew), 0U) << "tick " << tick;
        most = std::max(most, norm(here.sent));
    }
    EXPECT_GT(most, 0.1);
}

TEST(GuardedLoop, IsSmoothOnACoarseEncoderAndAMisjudgedMass) {
    for (const double damping : {0.5, 1.0, 2.0, 5.0}) {
        for (const int delay : {0, 1}) {
            for (const double misjudged : {1 / 1.5, 1.0, 1.5}) {
                ArmPhysics arm = test::textbookArm(damping, delay);
                arm.resolution = 55e-6;
                arm.maxForce = 3.3;
                arm.reach = 0.075;
                ArmPhysics claimed = arm;
                claimed.mass *= misjudged;
                const auto path = test::toAndFro(0.0024, 0.3, 2.01);
                ArmSession session(papersSand(), std::make_unique<SimulatedArm>(arm, Grip{300, 5}, path),
                                   Guards::Mode::on, &claimed);
                session.warmUp();
                double squares = 0;
                Vec3 before;
                constexpr int kTicks = 1000;
                for (int tick = 0; tick < kTicks; ++tick) {
                    const Vec3 sent = session.tick().sent;
                    squares += dot(sent - before, sent - before);
                    before = sent;
                    ASSERT_LE(norm(sent), 3.3 * (1 + 1e-12));
                }
                EXPECT_LT(std::sqrt(squares / kTicks), 0.15)
                    << damping << " N s/m, delay " << delay << ", mass taken for " << misjudged << " of itself";
                EXPECT_LT(norm(session.arm().velocity()), 1e-3);
            }
        }
    }
}

TEST(GuardedLoop, StartsInsideTheSandByItsRamp) {
    ArmSession session(papersSand(), std::make_unique<SimulatedArm>(touchPreset()));
    session.arm().start({0, 0, -0.0024}, {});
    const ForceLimits& limits = session.hand().guards().limits();
    const double whole = limits.lawStiffness * 0.0024;
    double before = 0;
    for (int tick = 0; tick < 2500; ++tick) {
        const Tick& now = session.tick();
        const double share = std::min(tick * kTick / ForceLimits::kRamp, 1.0);
        EXPECT_LE(norm(now.sent), share * limits.gain * norm(now.lawful) + 1e-12) << "tick " << tick;
        EXPECT_LE(norm(now.sent) - before, 1.1 * whole * kTick / ForceLimits::kRamp + 1e-12) << "tick " << tick;
        before = norm(now.sent);
    }
    EXPECT_GT(before, 0.2) << "a Touch's own friction holds it in the sand";
}

TEST(GuardedLoop, FallsSilentWithItsSandAndWithItsDevice) {
    ArmSession session(papersSand(), std::make_unique<SimulatedArm>(touchPreset()));
    session.warmUp();
    session.arm().start({0, 0, -0.0024}, {});
    const auto settle = [&] {
        for (int tick = 0; tick < 2100; ++tick) {
            (void)session.tick();
        }
        return norm(session.hand().lastTick().sent);
    };
    const double whole = settle();
    EXPECT_GT(whole, 0.2);
    EXPECT_GT(norm(session.tick(0.049).sent), 0.9 * whole);
    EXPECT_EQ(norm(session.tick(0.051).sent), 0) << "sand from more than 50 ms ago";
    EXPECT_LT(norm(session.tick().sent), 0.01 * whole) << "the ramp begins";
    EXPECT_NEAR(settle(), whole, 0.05 * whole);
    EXPECT_EQ(norm(session.tick(0, 0.02).sent), 0) << "twenty ticks missed";
    EXPECT_NEAR(settle(), whole, 0.05 * whole);
    session.arm().start({std::nan(""), 0, 0}, {});
    EXPECT_EQ(norm(session.tick().sent), 0);
    EXPECT_NE(session.hand().lastTick().guards & bit(Guard::notANumber), 0U);
    EXPECT_FALSE(session.sample().engaged) << "and the wall's tool hovers";
}

/// Makes 60 steps per second between the ticks of a hand, as the sand thread does.
class MovingSand {
public:
    MovingSand(const scene::Scene& scene, ArmSession& hand)
        : scene_(scene), replica_(scene), hand_(hand), path_(kStepsPerSecond) {
        publish();
    }

    /// Runs a tick. Returns whether it was the first on a new surface.
    bool tick() {
        const bool fresh = fresh_;
        fresh_ = false;
        const double since = hand_.time() - stepTime_;
        (void)hand_.tick(since + kTick);
        path_.add(hand_.sample());
        ++ticks_;
        if (ticks_ * kStepsPerSecond / 1000 != (ticks_ - 1) * kStepsPerSecond / 1000) {
            sand::Step step{1, replica_.stepNumber() + 1, false, {}};
            (void)path_.take(step);
            replica_.apply(step);
            publish();
        }
        return fresh;
    }

private:
    static constexpr int kStepsPerSecond = 60;

    void publish() {
        hand_.surface().patch = {samples::fieldOf(replica_), replica_.probe(), scene_.toolRadius()};
        hand_.surface().step = replica_.stepNumber();
        stepTime_ = hand_.time();
        fresh_ = true;
    }
    const scene::Scene& scene_;
    sand::Replica replica_;
    ArmSession& hand_;
    PathBuilder path_;
    long ticks_ = 0;
    double stepTime_ = 0;
    bool fresh_ = false;
};

TEST(GuardedLoop, GainsNothingFromSandThatIsDisplacedAndErodes) {
    const scene::Scene scene = test::levelSand({}, 128, 0.25);  // a radius is five cells
    const auto path = test::toAndFro(0.0016, 0.012, 2.01);      // two radii deep, for 6 mm
    ArmSession session(scene, std::make_unique<SimulatedArm>(touchPreset(), Grip{300, 5}, path));
    MovingSand sand(scene, session);
    while (session.time() < 2.01) {
        (void)sand.tick();
    }
    const PassivityObserver& observer = session.hand().guards().passivity();
    double least = observer.returned(), mostAfterwards = 0, jump = 0, lastSpeed = 0;
    Vec3 before = session.hand().lastTick().sent;
    for (int tick = 0; tick < 3000; ++tick) {
        const bool fresh = sand.tick();
        const Vec3 sent = session.hand().lastTick().sent;
        jump = fresh ? std::max(jump, norm(sent - before)) : jump;
        before = sent;
        if (tick >= 600) {  // the hand rests while the sand still slides
            least = std::min(least, observer.returned());
            mostAfterwards = std::max(mostAfterwards, observer.returned() - least);
        }
        lastSpeed = tick >= 2900 ? std::max(lastSpeed, norm(session.arm().velocity())) : lastSpeed;
    }
    EXPECT_LT(observer.returned(), 0) << "the hand has worked on the sand, not the sand on the hand";
    const double held = dot(before, before) / (2 * session.hand().guards().limits().lawStiffness);
    EXPECT_LT(mostAfterwards, held) << "at rest the hand gets at most the energy that the spring held";
    EXPECT_LT(lastSpeed, 1e-3);
    EXPECT_LT(jump, 0.15);
    EXPECT_GT(norm(before), 0.02);
    std::printf("worked %.3g J on the sand, got back at most %.3g J at rest; largest jump at a new surface %.3g N\n",
                -observer.returned(), mostAfterwards, jump);
}

/// A tip that moves at random, through the sand and above it, never faster than 1 m/s.
class Wanderer {
public:
    explicit Wanderer(unsigned seed) : random_(seed) {}
    Vec3 next() {
        std::normal_distribution<double> normal(0, 1);
        // The tip is pulled towards its start, so that it is in the sand for half of the time.
        const Vec3 wish{normal(random_) - 100 * place_.x, normal(random_) - 100 * place_.y,
                        normal(random_) - 300 * place_.z};
        speed_ = speed_ + 0.02 * wish;
        const double size = norm(speed_);
        speed_ = size > 1 ? (1 / size) * speed_ : speed_;
        place_ = place_ + kTick * speed_;
        return place_;
    }

private:
    std::mt19937 random_;
    Vec3 place_, speed_;
};

TEST(GuardedForce, IsContinuousPointsOutOfTheSandAndIsNothingOverIt) {
    const unsigned seed = test::randomSeed();
    SCOPED_TRACE(test::again(seed));
    for (const std::string_view name : kArmPresets) {
        ArmSession session(papersSand(), std::make_unique<SimulatedArm>(*armPreset(name)));
        session.warmUp();
        Wanderer tip(seed);
        const ForceLimits& limits = session.hand().guards().limits();
        Vec3 before;
        int inside = 0, outside = 0;
        for (int tick = 0; tick < 4000; ++tick) {
            const Vec3 at = tip.next();
            session.arm().start(at, {});
            const Tick& now = session.tick();
            // The change has three parts, each half of a tick's slew: the way at 1 m/s, the observer's damping, and
            // friction that reverses.
            ASSERT_LE(norm(now.sent - before), 1.5 * limits.slew) << name << ", tick " << tick;
            ASSERT_GE(now.sent.z, 0) << name << ", tick " << tick;
            if (now.place.z >= kPapersTouch) {
                ASSERT_EQ(norm(now.sent), 0) << name << ", tick " << tick;
                ++outside;
            } else {
                inside += norm(now.sent) > 0 ? 1 : 0;
            }
            before = now.sent;
        }
        EXPECT_GT(inside, 400);
        EXPECT_GT(outside, 400);
    }
}

TEST(GuardedForce, DoesNoWorkOnAClosedPathInLevelSandButFriction) {
    for (const double friction : {0.0, 10.0}) {
        sand::ForceConstants constants;
        constants.friction = friction;
        const scene::Scene scene = test::levelSand(constants);
        ArmPhysics arm = touchPreset();
        arm.resolution = 0;
        ArmSession session(scene, std::make_unique<SimulatedArm>(arm));
        session.warmUp();
        // Down, across, up and back at 10 mm/s.
        const std::array<Vec3, 5> corners{
            {{0, 0, 1e-4}, {0, 0, -2e-3}, {5e-3, 0, -2e-3}, {5e-3, 0, 1e-4}, {0, 0, 1e-4}}};
        double work = 0, turnover = 0;
        Vec3 before = corners[0];
        Vec3 sent;
        for (std::size_t leg = 1; leg < corners.size(); ++leg) {
            const Vec3 way = corners[leg] - corners[leg - 1];
            const int ticks = static_cast<int>(norm(way) / 1e-5);
            for (int tick = 1; tick <= ticks; ++tick) {
                const Vec3 at = corners[leg - 1] + (static_cast<double>(tick) / ticks) * way;
                session.arm().start(at, {});
                const Vec3 now = session.tick().sent;
                work += 0.5 * dot(now + sent, at - before);  // trapezium rule: no lag of a sample
                turnover += std::abs(dot(now, at - before));
                before = at;
                sent = now;
            }
        }
        if (friction == 0) {
            EXPECT_LT(std::abs(work), 0.01 * turnover);
        } else {
            EXPECT_LT(work, -0.01 * turnover);
        }
    }
}

}  // namespace
