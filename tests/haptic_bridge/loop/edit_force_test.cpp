// SPDX-License-Identifier: Apache-2.0
// Edits of an operator under a hand that holds against the sand: the force crosses over within 50 ms.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "haptic_bridge/loop/guards/cross_over.hpp"
#include "tests/haptic_bridge/loop/guarded_server.hpp"

namespace {

using namespace haptic_bridge;
using sand::force::Vec3;
using test::kToolInArm;
using test::VirtualServer;

constexpr int kCrosses = 50;  // [tick]

/// A hand that presses four tool radii deep, until a test moves it. The law asks for the arm's 8 N there.
class EditUnderLoad : public test::GuardedServer {
protected:
    void openAndPress() {
        at_ = {0, 0, -4 * kToolInArm};
        way_ = {};
        first_ = true;
        open(
            [this](double) {
                at_ = at_ + way_;
                return ArmReading{at_, first_, false, true};
            },
            1, {"engage=button"});
        server_->link();
        server_->run(4);
    }
    /// Gives an edit, and runs until it is felt. Returns the force before that tick.
    double edit(sand::Edit edit) {
        server_->edit(std::move(edit));
        double before = 0;
        do {
            before = force();
            server_->tick();
        } while (!server_->last().edited);
        return before;
    }
    /// Runs a cross-over. Returns the largest fall in a tick [N], from the tick that feels the edit on.
    double largestFall(double before) {
        double fall = before - force();
        for (int tick = 1; tick < kCrosses; ++tick) {
            const double last = force();
            server_->tick();
            fall = std::max(fall, last - force());
        }
        return fall;
    }
    /// Returns the force that the guards before the gate allow at the last tick.
    [[nodiscard]] bool crosses() const { return (server_->last().guards & bit(Guard::edit)) != 0; }

    Vec3 at_, way_;  // [m], [m/tick]
    bool first_ = true;
};

// 8 N go within 50 ticks, 0.16 N each, beside the sand that still moves. The bar is one slew limit of this arm.
TEST_F(EditUnderLoad, ASmallerToolLetsTheForceFallWithinFiftyMilliseconds) {
    openAndPress();
    const double slew = server_->hand().guards().limits().slew;
    EXPECT_NEAR(slew, 0.667, 1e-3);
    const double before = edit(toolOf(0.2));
    EXPECT_GT(before, 7);
    EXPECT_LT(largestFall(before), 0.25);
    server_->tick();
    EXPECT_FALSE(crosses());
    EXPECT_LT(force(), 3);
}

TEST_F(EditUnderLoad, NoEditLetsTheForceFallAtOnceWithAnyLaw) {
    struct Way {
        const char* name;
        std::function<void()> prepare;
        std::function<sand::Edit()> edit;
        bool falls = true;
    };
    const Way ways[]{
        {"a smaller tool", [] {}, [this] { return toolOf(0.2); }},
        {"load of lower sand", [] {}, [this] { return levelAt(-30); }},
        {"reset after a load of higher sand", [this] { (void)edit(levelAt(20)); },
         [] { return sand::Edit(sand::Edit::reset); }},
        {"a smaller tool in higher sand", [this] { (void)edit(levelAt(20)); }, [this] { return toolOf(0.1); }},
        {"undo of a smaller tool's stroke", [this] { (void)edit(toolOf(0.2)); },
         [] { return sand::Edit(sand::Edit::undo); }, false},
    };
    forEachLaw(1e5, [&] {
        const bool local = scene_.force.between == sand::Between::local;
        for (const Way& way : ways) {
            SCOPED_TRACE(way.name);
            openAndPress();
            at_ = {0, 0, -2 * kToolInArm};  // half a reach is 5 tool radii
            server_->run(1);
            way.prepare();
            server_->run(1);
            const double slew = server_->hand().guards().limits().slew;
            const double before = edit(way.edit());
            EXPECT_LE(largestFall(before), std::max(slew, before / kCrosses * 2));
            server_->tick();
            EXPECT_FALSE(crosses());
            EXPECT_GT(way.falls ? before - force() : 2, local ? 1 : 0.02) << "an edit without effect shows nothing";
        }
    });
}

// A stroke in which friction is as great as the push. An operator makes the sand slippery.
TEST_F(EditUnderLoad, ASlipperyMaterialTakesTheFrictionWithinFiftyMilliseconds) {
    scene_.force.friction = 1000;
    double time = 0;
    open([&time](double) {
        time += 1e-3;
        return ArmReading{
            {0.02 * std::sin(12.5 * time), 0, -1.5 * kToolInArm * std::min(time, 1.0)}, true, false, true};
    });
    server_->link();
    server_->run(4.02);  // 0.25 m/s; 4.02 s are 16 half strokes
    const Vec3 old = server_->pushed();
    ASSERT_GT(std::hypot(old.x, old.y), 0.5);
    const double before = edit(talus(5));
    EXPECT_LT(largestFall(before), 0.667);
    EXPECT_LT(std::hypot(server_->pushed().x, server_->pushed().y), 0.4);
}

TEST_F(EditUnderLoad, AFaultDuringACrossOverSendsZeroAtOnce) {
    openAndPress();
    (void)edit(toolOf(0.2));
    server_->run(0.005);
    EXPECT_GT(force(), 5);
    at_.x = std::nan("");
    server_->tick();
    EXPECT_EQ(force(), 0);
    at_ = {0, 0, -4 * kToolInArm};
    server_->run(0.02);
    EXPECT_LT(force(), 0.1) << "the old force does not come back";
}

TEST_F(EditUnderLoad, AToolThatIsLiftedDuringACrossOverIsFreeAtOnce) {
    openAndPress();
    (void)edit(toolOf(0.2));
    EXPECT_GT(force(), 5);
    first_ = false;
    server_->tick();
    EXPECT_EQ(force(), 0);
}

// K is 333 N/m: at 0.2 m/s a hand that leaves the sand loses at least 0.067 N a tick, beside the cross-over.
TEST_F(EditUnderLoad, AHandThatMovesOutIsHeldBackNoLongerThanWithoutTheEdit) {
    for (const Vec3 out : {Vec3{0, 0, 2e-4}, Vec3{0, 0, 2e-3}, Vec3{1e-3, 0, 1e-3}}) {
        std::vector<double> without;
        for (const bool edited : {false, true}) {
            openAndPress();
            at_ = {0, 0, -2 * kToolInArm};
            server_->run(2);
            if (edited) {
                (void)edit(toolOf(0.9));
            } else {
                server_->run(0.02);
            }
            way_ = out;
            for (int tick = 0; tick < kCrosses; ++tick) {
                server_->tick();
                if (!edited) {
                    without.push_back(force());
                } else {
                    EXPECT_LE(force(), without[static_cast<std::size_t>(tick)] + 0.05) << "tick " << tick;
                }
            }
            way_ = {};
        }
    }
}

// The force that was pushed acts one tick later, because the arm has a delay of one tick.
TEST_F(EditUnderLoad, TheObserverCountsTheEnergyOfACrossOver) {
    openAndPress();
    const auto& observer = server_->hand().guards().passivity();
    const double before = observer.returned();
    way_ = {0, 0, 5e-5};
    double given = 0;
    server_->edit(toolOf(0.2));
    for (int tick = 0; tick < 100; ++tick) {
        server_->tick();
        const std::vector<test::Push>& pushes = server_->pushes;
        given += dot(pushes[pushes.size() - 3].force, way_);
    }
    EXPECT_GT(server_->counted(Guard::edit), 40U);
    EXPECT_GT(given, 1e-3);
    EXPECT_NEAR(observer.returned() - before, given, 1e-3 * given);
}

/// Limits of a device of 8 N that may get 300 N/m.
ForceLimits someLimits() {
    ForceLimits limits;
    limits.stiffness = 300;
    limits.maxForce = 8;
    return limits;
}

/// A cross-over from 5 N along z to 0, tick by tick.
struct FromFive {
    CrossOver crossOver{someLimits()};
    CrossOver::Tick tick;

    explicit FromFive(double newton = 5) { (void)crossOver.next(tick, {0, 0, newton}); }
    double next(Vec3 way = {}) {
        tick.time += 1e-3;
        tick.place = tick.place + way;
        return crossOver.next(tick, {}).z;
    }
    double begin() {
        tick.edited = true;
        const double first = next();
        tick.edited = false;
        return first;
    }
};

TEST(CrossOver, TakesTheSamePartInEachOfFiftyTicks) {
    FromFive crossing;
    double before = 5, now = crossing.begin();
    for (int tick = 1; tick <= kCrosses; ++tick) {
        EXPECT_NEAR(before - now, 0.1, 1e-9) << tick;
        before = now;
        now = crossing.next();
    }
    EXPECT_NEAR(before, 0, 1e-9);
}

TEST(CrossOver, BeginsWithWhatWasPassedOfWhatTheDeviceCanPush) {
    FromFive beyond(50);
    EXPECT_NEAR(beyond.begin(), 8 * (1 - 1.0 / kCrosses), 1e-9);
    FromFive growing;
    growing.tick.passed = 0.2;
    EXPECT_NEAR(growing.begin(), 1 - 1.0 / kCrosses, 1e-9);
}

TEST(CrossOver, AimsAtWhatTheLawAsksForNow) {
    CrossOver crossOver(someLimits());
    (void)crossOver.next({}, {0, 0, 1});
    double force = 0;
    for (int tick = 1; tick <= kCrosses; ++tick) {
        const Vec3 wanted{0, 0, tick < 25 ? 3.0 : 2.0};
        force = crossOver.next({.time = tick * 1e-3, .edited = tick == 1}, wanted).z;
        EXPECT_LE(force, 2.0) << tick;
    }
    EXPECT_NEAR(force, 2, 1e-9);
}

// A way of 1 mm along the force or across it takes 0.3 N more.
TEST(CrossOver, FallsByTheStiffnessTimesTheWayOfAHandThatMovesOut) {
    for (const Vec3 way : {Vec3{0, 0, 1e-3}, Vec3{1e-3, 0, 0}, Vec3{0, -1e-3, -5e-3}}) {
        FromFive crossing;
        const double before = crossing.begin();
        EXPECT_NEAR(crossing.next(way), (before - 0.3) * (1 - 1.0 / 49), 1e-9);
    }
    FromFive deeper;
    const double before = deeper.begin();
    EXPECT_NEAR(deeper.next({0, 0, -1e-3}), before - 0.1, 1e-9) << "a hand that moves deeper";
}

TEST(CrossOver, EndsWhenTheToolIsLiftedOrAFaultComes) {
    FromFive lifted;
    (void)lifted.begin();
    lifted.tick.engaged = false;
    EXPECT_EQ(lifted.next(), 0);
    FromFive failed;
    (void)failed.begin();
    failed.crossOver.stop();
    EXPECT_EQ(failed.next(), 0);
}

TEST(CrossOver, DoesNotBeginWithoutAForce) {
    CrossOver crossOver(someLimits());
    (void)crossOver.next({}, {});
    EXPECT_EQ(crossOver.next({.time = 1e-3, .edited = true}, {0, 0, 2}).z, 2);
}

}  // namespace
