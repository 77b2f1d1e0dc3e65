// SPDX-License-Identifier: Apache-2.0
// Ways around the guards, tried on a whole server under a virtual clock. Every push of the arm is checked.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scene/model/scene.hpp"
#include "tests/haptic_bridge/loop/guarded_server.hpp"

namespace {

using namespace haptic_bridge;
using test::kToolInArm;
using test::VirtualServer;

/// Returns a path that rests at `depth` [tool radius] below level sand.
test::LoggingArm::Path restsAt(double depth) {
    return [depth](double) { return ArmReading{{0, 0, -depth * kToolInArm}, true, false, true}; };
}
class WayAround : public test::GuardedServer {};

TEST_F(WayAround, AServerPushesNothingBeforeAndAfterAMaster) {
    open(restsAt(1));
    server_->run(0.5);
    EXPECT_EQ(greatest(0.5), 0);
    server_->link();
    server_->run(3);
    EXPECT_GT(force(), 1);
    server_->unlink();
    server_->tick();
    EXPECT_EQ(force(), 0);
    server_->run(0.5);
    EXPECT_EQ(greatest(0.5), 0);
}

TEST_F(WayAround, NoMessageLiftsTheForceOfAServerThatAPersonHasStarted) {
    open(restsAt(1), 0);  // --force off
    server_->link({1, true});
    server_->run(1);
    server_->share(ForceShare{1, true});
    server_->run(3);
    EXPECT_EQ(greatest(4), 0);
    open(restsAt(1));
    server_->link({1, true});
    server_->run(3);
    const double whole = force();
    ASSERT_GT(whole, 1);
    open(restsAt(1), 0.4);  // --force-scale
    server_->link({1, true});
    server_->run(3);
    EXPECT_NEAR(force(), 0.4 * whole, 0.01 * whole);
    server_->share(ForceShare{0.1, true});
    server_->run(1);
    EXPECT_NEAR(force(), 0.1 * whole, 0.01 * whole) << "an operator can lower it";
}

TEST_F(WayAround, AnOperatorsShareHoldsOverTheOptionsOfTheSessionsOwnServerInBothDirections) {
    open(restsAt(1), 0);  // --force off
    server_->forceUntilCtl = true;
    server_->link();
    server_->run(3);
    EXPECT_EQ(greatest(3), 0) << "no operator has set a share";
    server_->share(ForceShare{1, true});
    server_->run(1);
    EXPECT_GT(force(), 1) << "ctl force on";
    server_->share(ForceShare{0, true});
    server_->run(1);
    EXPECT_EQ(greatest(0.5), 0) << "ctl force off";
    server_->unlink();
    server_->link({0, true});  // the restarted master tells the share of its journal
    server_->run(3);
    EXPECT_EQ(greatest(3), 0) << "after a restart";
    server_->unlink();
    server_->link({1, false});
    server_->run(3);
    EXPECT_EQ(greatest(3), 0) << "another session starts under the server's own options";
}

TEST_F(WayAround, OneSessionsForceOffDoesNotSilenceTheNext) {
    open(restsAt(1));
    server_->link({0, true});
    server_->run(3);
    EXPECT_EQ(greatest(3), 0);
    server_->unlink();
    server_->link({1, false});
    server_->run(3);
    EXPECT_GT(force(), 1);
}

TEST_F(WayAround, FrictionFollowsTheTalusOfTheSandAtTheHand) {
    // A stroke to and fro at 0.25 m/s, deeper than a radius, where the push is vertical. Only friction is horizontal.
    const auto stroke = [](double time) {
        return ArmReading{
            {0.02 * std::sin(12.5 * time), 0, -1.5 * kToolInArm * std::min(time, 1.0)}, true, false, true};
    };
    const auto steepest = [&](double seconds) {
        double ratio = 0;
        for (int tick = 0; tick < seconds * 1000; ++tick) {
            server_->tick();
            const test::Push& push = server_->pushes.back();
            ratio = push.force.z > 0.5 ? std::max(ratio, std::hypot(push.force.x, push.force.y) / push.force.z) : ratio;
        }
        return ratio;
    };
    const double held = std::tan(5 * std::numbers::pi / 180);
    scene_.force.friction = 1000;  // more than any talus holds
    open(stroke);
    server_->link();
    server_->run(3);
    EXPECT_NEAR(steepest(1), std::tan(34 * std::numbers::pi / 180), 1e-3);
    server_->edit(talus(5));
    server_->run(0.1);
    EXPECT_NEAR(server_->last().talus, held, 1e-4);
    EXPECT_NEAR(steepest(1), held, 1e-3);
    // A master that has resumed such a session gives the tuned sand to another server.
    const sand::Replica tuned = server_->sand();
    open(stroke);
    server_->link({}, tuned);
    server_->run(3);
    EXPECT_NEAR(server_->last().talus, held, 1e-4);
    EXPECT_NEAR(steepest(1), held, 1e-3) << "after a resume";
}

// The wall shows nothing for eight seconds, as when its master hangs.
TEST_F(WayAround, SandWithoutStepsFadesAndComesBackWhenStepsHaveComeForASecond) {
    open(restsAt(1));
    server_->link();
    server_->run(4);
    const double whole = force();
    ASSERT_GT(whole, 1);
    server_->sandIsStopped = true;
    server_->run(8.0 / 60 + 0.2);
    EXPECT_NEAR(force(), whole, 0.05 * whole) << "a hiccup of the wall";
    server_->run(0.2);
    EXPECT_EQ(force(), 0);
    server_->run(8);
    EXPECT_EQ(greatest(8), 0);
    EXPECT_EQ(server_->counted(Guard::stale), 0U) << "the thread that makes steps still copies its sand";
    EXPECT_GT(server_->counted(Guard::frozen), 8000U);
    server_->sandIsStopped = false;
    server_->run(0.99);
    EXPECT_EQ(greatest(0.9), 0) << "steps must come for a second";
    server_->run(0.3);
    EXPECT_GT(force(), 0.3 * whole);
    EXPECT_LT(force(), 0.8 * whole) << "the ramp of half a second";
    server_->run(0.4);
    EXPECT_NEAR(force(), whole, 0.05 * whole);
}

TEST_F(WayAround, AHungSandThreadIsStaleAtOnce) {
    open(restsAt(1));
    server_->link();
    server_->run(4);
    const double whole = force();
    ASSERT_GT(whole, 1);
    server_->sandThreadHangs = true;
    server_->run(0.040);
    EXPECT_GT(force(), 0.9 * whole);
    server_->run(0.025);
    EXPECT_EQ(force(), 0);
    EXPECT_GT(server_->counted(Guard::stale), 0U);
    server_->sandThreadHangs = false;
    server_->run(0.5);
    EXPECT_LT(force(), 0.3 * whole) << "the ramp of two seconds";
    server_->run(2);
    EXPECT_NEAR(force(), whole, 0.05 * whole);
}

TEST_F(WayAround, SlowStepsAreNoHungThread) {
    for (const int perSecond : {1, 5, 19}) {
        scene_.rules.stepsPerSecond = perSecond;
        open(restsAt(1));
        server_->link();
        server_->run(5);
        EXPECT_GT(force(), 1) << perSecond << " steps per second";
        EXPECT_EQ(server_->counted(Guard::stale), 0U) << perSecond;
        EXPECT_EQ(server_->counted(Guard::frozen), 0U) << perSecond;
    }
}

/// Returns the tick at which the force first exceeds `share` of its final value, counted from tick `from`.
std::size_t reaches(const VirtualServer& server, std::size_t from, double share) {
    const double whole = norm(server.pushed());
    std::size_t tick = from;
    while (norm(server.pushes[tick].force) < share * whole) {
        ++tick;
    }
    return tick - from;
}

TEST_F(WayAround, AButtonThatEngagesTheToolInDeepSandIsFeltInARamp) {
    double pressedAt = 1e9;
    open(
        [&pressedAt](double time) {
            return ArmReading{{0, 0, -4 * kToolInArm}, time >= pressedAt, false, true};
        },
        1, {"engage=button"});
    server_->link();
    server_->run(3);
    EXPECT_EQ(force(), 0);
    const std::size_t from = server_->pushes.size();
    pressedAt = 0;
    server_->run(1);
    EXPECT_GT(force(), 7);
    EXPECT_GT(reaches(*server_, from, 0.9), 150U) << "ticks";
    EXPECT_GT(server_->counted(Guard::contact), 100U);
    EXPECT_EQ(server_->counted(Guard::gate), 0U);
}

TEST_F(WayAround, SandThatAnEditPutsOnAHandIsFeltInARamp) {
    struct Way {
        const char* name;
        std::function<sand::Edit(const VirtualServer&)> edit;
    };
    const Way wider{"a wider tool", [](const VirtualServer& server) {
                        sand::Tuning tuning = server.sand().rules().tuning;
                        tuning.tool.radius *= 4;
                        return sand::Edit::tuned(tuning);
                    }};
    const Way reset{"reset", [](const VirtualServer&) { return sand::Edit(sand::Edit::reset); }};
    const Way load{"load", [this](const VirtualServer&) {
                       scene::Scene high = scene_;
                       for (int y = 0; y < high.rules.rows; ++y) {
                           for (int x = 0; x < high.rules.columns; ++x) {
                               high.terrain.setHeight(x, y, 20 * sand::kUnitsPerCell);
                           }
                       }
                       return sand::Edit::loaded(sand::Replica(high).copySand()->encode());
                   }};
    const Way pressed{"a wider tool of a hand that presses", wider.edit};
    for (const Way& way : {wider, pressed, reset, load}) {
        SCOPED_TRACE(way.name);
        // The hand rests just above the sand. For `reset` it has dug a wide pit before, and rests in it.
        const bool inPit = std::string(way.name) == "reset", presses = way.name == pressed.name;
        open([inPit, presses](double time) {
            const double out = inPit ? 0.03 * std::clamp(4 - time, 0.0, 1.0) * std::sin(3 * time) : 0;
            const double depth = presses ? 0.3 : !inPit ? -0.2 : time < 4 ? 2 : 1.2;
            return ArmReading{
                {out * std::cos(40 * time), out * std::sin(40 * time), -depth * kToolInArm}, true, false, true};
        });
        server_->link();
        server_->run(6);
        const double before = force();
        server_->edit(way.edit(*server_));
        const std::size_t from = server_->pushes.size();
        server_->run(1);
        EXPECT_GT(force(), before + 1) << "the edit must bury the hand";
        EXPECT_GT(server_->counted(Guard::contact), 100U);
        const double excess = force() - before;
        for (std::size_t i = from; i < server_->pushes.size(); ++i) {
            // An edit is felt at the next step, and then its excess grows within a fifth of a second. The sand still
            // settles, so that the last force is only near the one that the growth aimed at.
            const double allowed = before + 1.3 * excess * std::min(static_cast<double>(i - from) / 200, 1.0) + 0.3;
            ASSERT_LT(norm(server_->pushes[i].force), allowed) << i - from << " ticks after the edit";
        }
    }
}

TEST_F(WayAround, AContactAtTheSurfaceHasNoRamp) {
    // A tap: the hand is above the sand for 3 s, and then goes one radius deep and back within 100 ms.
    open([](double time) {
        const double down = std::clamp(1 - std::abs(time - 3.05) / 0.05, 0.0, 1.0);
        return ArmReading{{0, 0, kToolInArm * (0.1 - 1.1 * down)}, true, false, true};
    });
    server_->link();
    server_->run(3.05);
    EXPECT_GT(force(), 1.4) << "half of a radius is felt as 1 N per 3 mm";
    EXPECT_EQ(server_->counted(Guard::contact), 0U);
    EXPECT_EQ(server_->counted(Guard::slew), 0U);
    server_->run(0.2);
    EXPECT_EQ(force(), 0);
}

TEST_F(WayAround, TheClutchAndAPauseHaveRampsOfTheirOwnAndAreNoFaults) {
    bool clutch = false;
    open([&clutch](double) { return ArmReading{{0, 0, -kToolInArm}, true, clutch, true}; });
    server_->link();
    server_->run(4);
    const double whole = force();
    clutch = true;
    server_->run(0.06);
    EXPECT_EQ(force(), 0);
    clutch = false;
    server_->run(0.55);
    EXPECT_NEAR(force(), whole, 0.05 * whole) << "half a second";
    server_->sandIsStopped = true;
    server_->run(1);
    EXPECT_EQ(force(), 0);
    server_->sandIsStopped = false;
    server_->run(1.6);
    EXPECT_NEAR(force(), whole, 0.05 * whole);
    EXPECT_EQ(server_->counted(Guard::missed) + server_->counted(Guard::lost) + server_->counted(Guard::stale), 0U);
}

TEST_F(WayAround, AnArmThatComesBackIsFeltInTheRampOfTwoSeconds) {
    bool there = true;
    double place = 0;
    open([&](double) { return ArmReading{{place, 0, -kToolInArm}, true, false, there}; });
    server_->link();
    server_->run(4);
    const double whole = force();
    ASSERT_GT(whole, 1);
    for (const double away : {0.0, std::nan("")}) {
        there = std::isnan(away);
        place = away;
        server_->run(there ? 0.001 : 0.011);  // ten lost readings only fade the force
        EXPECT_EQ(force(), 0);
        there = true;
        place = 0;
        server_->run(1);
        EXPECT_NEAR(force(), whole / 2, 0.1 * whole);
        server_->run(1.1);
        EXPECT_NEAR(force(), whole, 0.05 * whole);
    }
    server_->run(7);            // a third fault within ten seconds would switch the force off
    server_->tick(15'000'000);  // fifteen ticks missed
    EXPECT_EQ(force(), 0);
    server_->run(1);
    EXPECT_NEAR(force(), whole / 2, 0.1 * whole);
}

}  // namespace
