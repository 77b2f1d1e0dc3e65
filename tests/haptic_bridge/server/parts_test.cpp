// SPDX-License-Identifier: Apache-2.0
// Steps of a server while sweeps are owed.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "haptic_bridge/server/step_maker.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

using namespace haptic_bridge;

constexpr int kWhole = 150;  // sweeps of a step

scene::Scene sceneOfParts() {
    scene::Scene scene = samples::flatScene(80, 80, 12);
    scene.rules.tuning.sweepsPerStep = kWhole;
    return scene;
}

StepMaker::Output into(std::vector<StepMessage>& steps) {
    return {[](std::uint32_t) {}, [](std::uint32_t, NeedState) {}, [](std::uint32_t, const std::string&) {},
            [&steps](std::uint32_t, const base::Bytes& message, std::uint64_t) {
                steps.push_back(std::get<StepMessage>(decode(std::span(message).subspan(kLengthBytes))));
            }};
}

/// A hand in real time, whose next samples come from the test.
class WaitingHand : public DeviceHand {
public:
    using DeviceHand::DeviceHand;
    void drain() override {
        for (const HandSample& sample : std::exchange(samples, {})) {
            add(sample);
        }
    }
    void publish(const sand::Replica&, bool) override { sinceNs.push_back(engagedSinceNs().value_or(0)); }
    [[nodiscard]] bool onHostClock() const override { return true; }

    std::vector<HandSample> samples;
    std::vector<std::int64_t> sinceNs;  // at every publish
};

/// A server in real time, without a thread and a link.
class Parts : public testing::Test {
protected:
    Parts() { maker_.start(1, {1, 0, sand::Replica(scene_).stateHash(), {}}); }

    /// Makes a step. The hand is at column `x` meanwhile.
    const StepMessage& step(int x, bool engaged = true) {
        hand_.samples.push_back({now_, {x * sand::kProbePerCell, 40 * sand::kProbePerCell, 0}, engaged});
        maker_.collect();
        maker_.makeStep();
        now_ += 1'000'000;
        return steps_.back();
    }
    /// Shows the last step, whose sweeps took so long each.
    void show(std::int64_t sweepNs, std::int64_t dragNs = 0, std::int64_t substeps = 0) {
        const std::int64_t sweeps = steps_.back().step.sweeps;
        maker_.shown({steps_.back().step.number,
                      16'666'667,
                      Held::no,
                      {.sweeps = sweeps, .substeps = substeps, .sweepNs = sweeps * sweepNs, .dragNs = dragNs}},
                     now_);
    }

    const scene::Scene scene_ = sceneOfParts();
    std::int64_t now_ = 1'000'000'000;
    std::vector<StepMessage> steps_;
    WaitingHand hand_{scene_.rules.stepsPerSecond};
    StepMaker maker_{sand::Replica(scene_), hand_, into(steps_), [this] { return now_; }};
};

TEST_F(Parts, TheMovementOfTheHandWaitsUntilAllIsPaid) {
    EXPECT_EQ(step(20).step.sweeps, 64) << "the first part of a stroke";
    ASSERT_EQ(maker_.sand().owed().left(), kWhole - 64);
    const std::int64_t waitsSince = now_;
    show(1000);
    const StepMessage second = step(21);
    EXPECT_EQ(second.step.sweeps, kWhole - 64);
    EXPECT_TRUE(second.step.engaged);
    EXPECT_TRUE(second.step.path.empty());
    EXPECT_EQ(second.serverTimeNs, 0) << "a step without a sample has no latency";
    EXPECT_EQ(hand_.sinceNs.back(), waitsSince) << "the guards see how long the movement waits";
    show(1000);
    const StepMessage third = step(22);
    ASSERT_EQ(third.step.path.size(), 2U);
    EXPECT_EQ(third.step.path.front().x, 21 * sand::kProbePerCell);
    EXPECT_EQ(third.step.sweeps, kWhole) << "less than twice the second part";
    EXPECT_EQ(third.serverTimeNs, now_ - 1'000'000);
    EXPECT_EQ(hand_.sinceNs.back(), 0);
    EXPECT_EQ(hand_.dropped(), 0U);
}

TEST_F(Parts, AHandThatHoversGoesOnMeanwhile) {
    const auto shown = [this](int x, bool engaged) {
        const StepMessage made = step(x, engaged);
        show(1'000'000);  // so that each step runs few sweeps
        return made;
    };
    (void)shown(20, true);
    while (maker_.sand().engaged()) {
        (void)shown(20, false);
    }
    ASSERT_TRUE(maker_.sand().owed().any());
    EXPECT_EQ(shown(30, false).step.path.back().x, 30 * sand::kProbePerCell);
    ASSERT_TRUE(maker_.sand().owed().any());
    while (maker_.sand().owed().any()) {
        const StepMessage waiting = shown(40, true);
        EXPECT_FALSE(waiting.step.engaged);
        EXPECT_TRUE(waiting.step.path.empty()) << "no tool engages while sweeps are owed";
        EXPECT_EQ(waiting.serverTimeNs, 0) << "a press that waits has no latency yet";
    }
    const StepMessage pressed = shown(40, true);
    EXPECT_TRUE(pressed.step.engaged);
    EXPECT_EQ(pressed.step.path.front().x, 40 * sand::kProbePerCell);
    EXPECT_EQ(hand_.dropped(), 0U);
}

TEST_F(Parts, OfAnExpensiveSandAreSmall) {
    (void)step(20);
    show(1'000'000);
    EXPECT_EQ(step(20).step.sweeps, 8) << "half of a period of 16.7 ms";
    show(4'000'000);
    EXPECT_EQ(step(20).step.sweeps, 2);
}

TEST_F(Parts, APathHasTheSubstepsThatFit) {
    (void)step(20);
    show(1, 8'000'000, 2);  // two sub-steps of 4 ms fit
    while (maker_.sand().owed().any()) {
        (void)step(20);
        show(1);
    }
    for (int x = 21; x <= 26; ++x) {
        hand_.samples.push_back({now_, {x * sand::kProbePerCell, 40 * sand::kProbePerCell, 0}, true});
    }
    EXPECT_EQ(step(27).step.path.size(), 2U) << "the rest of the path waits";
}

TEST_F(Parts, AnEditIsDoneWhileSweepsAreOwed) {
    (void)step(20);
    ASSERT_TRUE(maker_.sand().owed().any());
    maker_.edit({samples::withNumber(1, sand::Edit::undo)});
    EXPECT_EQ(step(21).step.edit.kind, sand::Edit::undo);
    EXPECT_EQ(maker_.sand().owed(), sand::Owed());
    EXPECT_EQ(step(22).step.path.size(), 2U);
}

/// A device that digs a circle.
class CirclingDevice : public Device {
public:
    [[nodiscard]] Pose read(double time) override {
        return {0.3 * std::cos(20 * time), 0.3 * std::sin(20 * time), 0.3, time > 0.05 && time < 0.4};
    }
    void sendForce(sand::force::Vec3) override {}
    [[nodiscard]] bool finished(double) const override { return false; }
};

// The virtual hand stands still while sweeps are owed. So the heights are those of whole steps.
TEST(PartsOfTheFastPace, LeaveTheSandOfWholeSteps) {
    const scene::Scene scene = sceneOfParts();
    HapticTick tick(scene, std::make_unique<CirclingDevice>(), HandSettings::Datum::level);
    const auto channel = std::make_unique<HandChannel>();
    VirtualHand hand(tick, *channel, scene.rules.stepsPerSecond);
    std::vector<StepMessage> steps;
    StepMaker maker(sand::Replica(scene), hand, into(steps));
    sand::Replica parts(scene), whole(scene);
    maker.start(1, {1, 0, parts.stateHash(), {}});
    int moved = 0, paid = 0;
    while (whole.stepNumber() < 30 || parts.owed().any()) {
        maker.makeStep();
        maker.shown({maker.sand().stepNumber(), 16'666'667, Held::no, {.sweeps = 64, .sweepNs = 1'000'000'000}}, 0);
        sand::Step step = steps.back().step;
        EXPECT_LE(step.sweeps, 64);
        const bool waits = parts.owed().any();
        parts.apply(step);
        ASSERT_EQ(parts.leftOut(), "");
        if (!waits) {
            step.number = whole.stepNumber() + 1;
            step.sweeps = 0;
            whole.apply(step);
            moved += step.engaged && !step.path.empty() ? 1 : 0;
        }
        paid += waits ? 1 : 0;
        if (!parts.owed().any()) {
            ASSERT_EQ(parts.copySand()->encode(), whole.copySand()->encode()) << "step " << whole.stepNumber();
        }
    }
    EXPECT_GT(moved, 10);
    EXPECT_GT(paid, moved) << "the test must spread its steps";
}

}  // namespace
