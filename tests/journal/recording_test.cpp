// SPDX-License-Identifier: Apache-2.0
#include "journal/recording.hpp"

#include <gtest/gtest.h>

#include "base/input_error.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

/// Returns a session of `steps` steps, 60 per second, with three steps per frame. Its hash after each step is 100 +
/// step.
journal::Journal sessionOf(std::uint64_t steps) {
    journal::Journal journal;
    journal.scene = samples::flatScene(8, 8);
    journal.scene.rules.stepsPerSecond = 60;
    for (std::uint64_t number = 1; number <= steps; ++number) {
        if (number % 3 == 1) {
            journal.frames.push_back({number, 100 + number - 1, {}});
        }
        journal.frames.back().steps.emplace_back().number = number;
    }
    journal.end = {steps, 100 + steps};
    return journal;
}

std::string refusal(journal::Journal journal) {
    try {
        const journal::Recording recording(std::move(journal), "FILE", 30);
    } catch (const base::InputError& error) {
        return error.what();
    }
    return "taken";
}

TEST(Recording, EachFrameShowsTheStepsOfItsTime) {
    for (const int rate : {1, 7, 24, 25, 30, 60, 144, 240}) {
        const journal::Recording recording(sessionOf(601), "FILE", rate);
        const auto perSecond = static_cast<std::uint64_t>(rate);
        ASSERT_EQ(recording.frames(), (601 * perSecond + 59) / 60);
        std::uint64_t shown = 0;
        for (std::uint64_t frame = 1; frame <= recording.frames(); ++frame) {
            for (const sand::Step& step : recording.stepsOf(frame)) {
                ASSERT_EQ(step.number, ++shown) << "frame " << frame << " of " << rate << " a second";
            }
            ASSERT_EQ(shown, std::min<std::uint64_t>(601, frame * 60 / perSecond)) << frame << " at " << rate;
        }
        EXPECT_EQ(shown, 601U) << rate;
    }
}

TEST(Recording, OfASpanLeadsToItsBeginningAndEndsAtItsEnd) {
    const journal::Recording recording(sessionOf(601), "FILE", 30, {130, 330});
    EXPECT_EQ(recording.framesBefore(), 3U);
    EXPECT_EQ(recording.frames(), 3U + 100) << "200 steps at 60 a second are 100 frames at 30 a second";
    EXPECT_EQ(recording.lastStep(), 330U);
    EXPECT_EQ(recording.shortcoming(), "");
    std::uint64_t shown = 0;
    for (std::uint64_t frame = 1; frame <= recording.frames(); ++frame) {
        for (const sand::Step& step : recording.stepsOf(frame)) {
            ASSERT_EQ(step.number, ++shown) << "frame " << frame;
        }
        ASSERT_EQ(shown, frame <= 3 ? std::min<std::uint64_t>(130, 60 * frame) : 130 + 2 * (frame - 3)) << frame;
    }
    EXPECT_EQ(shown, 330U);
}

// A running session may write the last record just now.
TEST(Recording, OfASpanThatIsThereIsWholeAlsoIfTheSessionGoesOn) {
    journal::Journal journal = sessionOf(9);
    journal.end.reset();
    journal.tornBytes = 7;
    EXPECT_EQ(journal::Recording(journal, "FILE", 30, {0, 6}).shortcoming(), "");
    EXPECT_NE(journal::Recording(journal, "FILE", 30, {3, journal::Span::kEnd}).shortcoming(), "");
}

TEST(Recording, RefusesASpanOutsideTheSession) {
    for (const journal::Span span : {journal::Span{0, 602}, {300, 300}, {400, 300}, {601, journal::Span::kEnd}}) {
        try {
            const journal::Recording recording(sessionOf(601), "FILE", 30, span);
            ADD_FAILURE() << span.from << " to " << span.to;
        } catch (const base::InputError& error) {
            EXPECT_EQ(std::string(error.what()).find("FILE: holds steps 1 to 601, and the film is to begin"), 0U)
                << error.what();
        }
    }
}

TEST(Recording, KnowsTheHashesThatTheSessionWrote) {
    const journal::Recording recording(sessionOf(10), "FILE", 30);
    for (const std::uint64_t step : {0U, 3U, 6U, 9U, 10U}) {
        EXPECT_EQ(recording.hashAfter(step), 100 + step);
    }
    for (const std::uint64_t step : {1U, 2U, 4U, 8U, 11U}) {
        EXPECT_EQ(recording.hashAfter(step), std::nullopt) << step;
    }
}

// The session has rested for an hour after step 6. A film has no frames of that hour.
TEST(Recording, LeavesOutTheTimeInWhichNothingMoved) {
    journal::Journal journal = sessionOf(12);
    journal.frames.insert(journal.frames.begin() + 2, journal::JournalFrame{7, 106, {}});
    for (std::size_t frame = 3; frame < journal.frames.size(); ++frame) {
        journal.frames[frame].frame += 216'000;
    }
    const journal::Recording recording(std::move(journal), "FILE", 30);
    EXPECT_EQ(recording.frames(), 6U);
    EXPECT_EQ(recording.hashAfter(6), 106U);
    for (std::uint64_t frame = 1; frame <= 6; ++frame) {
        EXPECT_EQ(recording.stepsOf(frame).size(), 2U) << frame;
    }
}

// 60 steps per second in films of 30 frames per second: frame n shows the steps up to 2n. Materials precede the frame
// of steps 4 to 6 (twice) and that of steps 10 to 12.
TEST(Recording, EachFrameHasTheHumidityOfItsSteps) {
    journal::Journal journal = sessionOf(12);
    const auto wet = [](double humidity) {
        scene::Material material;
        material.humidity = humidity;
        return material;
    };
    journal.scene.material = wet(0.5);
    journal.materials = {{1, wet(0.75)}, {1, wet(1)}, {3, wet(0.25)}};
    const journal::Recording recording(std::move(journal), "FILE", 30);
    const std::vector<double> want{0.5, 1, 1, 1, 0.25, 0.25};
    for (std::uint64_t frame = 1; frame <= want.size(); ++frame) {
        EXPECT_EQ(recording.humidityOf(frame), want[frame - 1]) << frame;
    }
}

TEST(Recording, SaysWhereACutOffSessionEnds) {
    EXPECT_EQ(journal::Recording(sessionOf(9), "FILE", 30).shortcoming(), "");
    journal::Journal journal = sessionOf(9);
    journal.end.reset();
    EXPECT_EQ(journal::Recording(journal, "FILE", 30).shortcoming(),
              "FILE: has no orderly end, the session was cut off; it ends at step 9");
    journal.tornBytes = 5;
    EXPECT_EQ(journal::Recording(journal, "FILE", 30).shortcoming(),
              "FILE: the last 5 bytes are an incomplete write and were left out; it ends at step 9");
}

TEST(Recording, RefusesASessionWithAHole) {
    journal::Journal journal = sessionOf(12);
    journal.frames.erase(journal.frames.begin() + 1);
    EXPECT_EQ(refusal(journal), "FILE: step 7 follows step 3; a part of the session is missing");
    journal = sessionOf(12);
    journal.frames.pop_back();
    EXPECT_EQ(refusal(journal), "FILE: holds 9 steps of a session that ended at step 12");
}

TEST(Recording, RefusesASessionWithoutSteps) {
    journal::Journal journal = sessionOf(3);
    journal.frames.clear();
    journal.end.reset();
    EXPECT_EQ(refusal(journal), "FILE: the journal holds no steps, so it cannot be replayed");
}

}  // namespace
