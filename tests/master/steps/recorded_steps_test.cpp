// SPDX-License-Identifier: Apache-2.0
#include "master/steps/recorded_steps.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/sand/no_steps.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

using master::ArrivedStep;

/// Records a session of `steps` steps, 60 per second, one per frame, with the hashes of its sand.
journal::Journal sessionWithHashes(std::uint64_t steps) {
    journal::Journal journal;
    journal.scene = samples::flatScene(24, 24);
    sand::Replica sand(journal.scene);
    std::mt19937 random(7);
    for (std::uint64_t number = 1; number <= steps; ++number) {
        const sand::Step step = samples::randomStep(number, journal.scene.rules, random);
        journal.frames.push_back({number, sand.stateHash(), {step}});
        sand.apply(step);
    }
    journal.end = {steps, sand.stateHash()};
    return journal;
}

std::shared_ptr<const journal::Recording> recordingOf(journal::Journal journal, int framesPerSecond = 60) {
    return std::make_shared<const journal::Recording>(std::move(journal), "FILE", framesPerSecond);
}

/// Shows a frame of the recording on a wall without ranks. Returns the number of its steps.
std::size_t showFrame(master::RecordedSteps& steps, sand::Replica& sand) {
    const std::vector<ArrivedStep> next = steps.next(sand, sand.stateHash(), steps.mostPerFrame());
    steps.reached(sand);
    for (const ArrivedStep& timed : next) {
        sand.apply(timed.step);
        steps.reached(sand);
    }
    return next.size();
}

TEST(RecordedSteps, ShowEachFrameTheStepsOfItsTimeAndEndWhereAsked) {
    const auto recording = recordingOf(sessionWithHashes(20), 30);
    master::RecordedSteps steps(recording, 7);
    sand::Replica sand(recording->scene());
    for (const std::size_t wanted : {2U, 2U, 2U, 1U, 0U}) {
        EXPECT_EQ(showFrame(steps, sand), wanted);
    }
    EXPECT_EQ(sand.stepNumber(), 7U);
    EXPECT_FALSE(steps.strayed());
    EXPECT_EQ(steps.force(), nullptr) << "a recording cannot be changed";
    EXPECT_STREQ(steps.hand(), "recorded");
}

TEST(RecordedSteps, SayOnceWhenTheSandDiffersFromTheRecordings) {
    journal::Journal journal = sessionWithHashes(10);
    journal.frames[4].hashBefore ^= 1;  // after step 4
    const auto recording = recordingOf(std::move(journal));
    master::RecordedSteps steps(recording, 10);
    sand::Replica sand(recording->scene());
    for (int frame = 0; frame < 3; ++frame) {
        showFrame(steps, sand);
    }
    EXPECT_FALSE(steps.strayed());
    showFrame(steps, sand);
    EXPECT_TRUE(steps.strayed());
    EXPECT_TRUE(steps.takeStrayLine().starts_with("after step 4: the session had "));
    EXPECT_EQ(steps.takeStrayLine(), "");
    showFrame(steps, sand);
    EXPECT_EQ(steps.takeStrayLine(), "") << "only the first difference is printed";
}

// Healing replaces the master's sand by the sand of the other ranks. Then the recording was right.
TEST(RecordedSteps, CompareAgainWhenTheMasterWasHealed) {
    const auto recording = recordingOf(sessionWithHashes(10));
    master::RecordedSteps steps(recording, 10);
    sand::Replica sand(recording->scene());
    showFrame(steps, sand);
    showFrame(steps, sand);
    sand::Replica right = sand;
    sand.corrupt(3, 3, 9);
    sand.audit(sand.hashTiles().tileCount());
    steps.reached(sand);
    ASSERT_TRUE(steps.strayed());
    steps.healed(sand);
    EXPECT_TRUE(steps.strayed()) << "the sand still differs";
    steps.healed(right);
    EXPECT_FALSE(steps.strayed());
    EXPECT_EQ(steps.takeStrayLine(), "");
}

/// A source that has a step at the third call of next().
class LateSteps : public test::NoSteps {
public:
    explicit LateSteps(double patience) : patience_(patience) {}
    std::vector<ArrivedStep> next(const sand::Replica& /* sand */, std::uint64_t /* hash */,
                                  std::size_t /* most */) override {
        return std::vector<ArrivedStep>(++calls == 3 ? 1 : 0);
    }
    [[nodiscard]] double patience() const override { return patience_; }

    int calls = 0;

private:
    double patience_;
};

TEST(AwaitSteps, AsksAgainOnlyWhileItsSourceIsPatientAndNobodyStops) {
    const sand::Replica sand(samples::flatScene(8, 8));
    const auto await = [&](LateSteps& source, std::size_t most, bool stop) {
        return master::awaitSteps(source, sand, 0, most, [&] { return stop; }).size();
    };
    LateSteps patient(60);
    EXPECT_EQ(await(patient, 1, false), 1U);
    EXPECT_EQ(patient.calls, 3);
    LateSteps impatient(0);
    EXPECT_EQ(await(impatient, 1, false), 0U);
    EXPECT_EQ(impatient.calls, 1);
    LateSteps stopped(60);
    EXPECT_EQ(await(stopped, 1, true), 0U);
    EXPECT_EQ(stopped.calls, 1);
    LateSteps held(60);
    EXPECT_EQ(await(held, 0, false), 0U) << "held sand takes no step and does not wait";
    EXPECT_EQ(held.calls, 1) << "the source is still called, because it serves the link";
}

}  // namespace
