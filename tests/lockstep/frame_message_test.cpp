// SPDX-License-Identifier: Apache-2.0
#include "lockstep/frame_message.hpp"

#include <gtest/gtest.h>

#include "lockstep/frame_barrier.hpp"
#include "lockstep/session_message.hpp"

namespace {

lockstep::FrameMessage digging() {
    lockstep::FrameMessage message{.frame = 100000,
                                   .view = {.head = {0.1, 1.6, 2.5}, .eyeSeparation = 0.065},
                                   .auditTiles = 4,
                                   .capture = true,
                                   .stop = false,
                                   .steps = {},
                                   .figures = {}};
    message.view.layers.set(lockstep::Overlay::hillShade, true);
    for (std::uint64_t i = 0; i < 8; ++i) {
        sand::Step& step = message.steps.emplace_back();
        step = {2, 500000 + i, true, {}};
        for (int sample = 0; sample < 17; ++sample) {
            step.path.push_back({60000 + 23 * sample, 70000 - 11 * sample, 512 + sample % 3});
        }
    }
    return message;
}

TEST(FrameMessage, SurvivesItsEncoding) {
    const lockstep::FrameMessage message = digging();
    EXPECT_EQ(base::decoded<lockstep::FrameMessage>(base::encoded(message)), message);
}

// All numbers are different, so that the test finds two that are exchanged.
TEST(FrameMessage, CarriesEveryFieldOfAView) {
    lockstep::ViewState view{.head = {1, 2, 3},
                             .right = {4, 5, 6},
                             .eyeSeparation = 7,
                             .sceneToRoom = {},
                             .pattern = 8,
                             .layers = lockstep::Overlays(9),
                             .stereo = 10,
                             .swapEyes = true,
                             .humidity = 0.25,
                             .window = {27, 28}};
    for (std::size_t i = 0; i < view.sceneToRoom.size(); ++i) {
        view.sceneToRoom.at(i) = 11 + static_cast<double>(i);
    }
    EXPECT_EQ(base::decoded<lockstep::ViewState>(base::encoded(view)), view);
}

TEST(FrameMessage, TellsAStopFromACaptureAndBothFromASharpPicture) {
    for (int flag = 0; flag < 3; ++flag) {
        lockstep::FrameMessage message = digging();
        message.stop = flag == 0;
        message.capture = flag == 1;
        message.sharp = flag == 2;
        const lockstep::FrameMessage copy = base::decoded<lockstep::FrameMessage>(base::encoded(message));
        EXPECT_EQ(copy.stop, flag == 0);
        EXPECT_EQ(copy.capture, flag == 1);
        EXPECT_EQ(copy.sharp, flag == 2);
    }
}

lockstep::FrameMessage observed() {
    lockstep::FrameMessage message = digging();
    message.answers = {{0, "F1 shows all keys"}, {7, "heading 35°"}};
    message.figures = {16.7, lockstep::Drag{5, 0.97, 30.1}, 99999, 1, 2, 3, 40, 1.25, {2, 7}, {0, 131, 20571, 4}};
    return message;
}

TEST(FrameMessage, CarriesWhatTheWallKnowsOfItself) {
    EXPECT_EQ(base::decoded<lockstep::FrameMessage>(base::encoded(observed())), observed());
    lockstep::FrameMessage nobodySlow = observed();
    nobodySlow.figures->slowest.reset();
    EXPECT_EQ(base::decoded<lockstep::FrameMessage>(base::encoded(nobodySlow)), nobodySlow);
}

// A wall is still for most of the day, and its frame messages must be short. Absent figures take no byte of their own.
TEST(FrameMessage, TakesNoByteForFiguresThatNobodyAskedFor) {
    lockstep::FrameMessage message = digging();
    const std::size_t unobserved = base::encoded(message).size();
    message.figures.emplace();
    EXPECT_GT(base::encoded(message).size(), unobserved);
    lockstep::FrameMessage still;
    still.frame = 1;
    EXPECT_EQ(base::encoded(still).size(), base::encoded(still.view).size() + 6)
        << "frame, hash tiles, flags, steps, answers, figures: a byte each";
}

TEST(FrameMessage, EightStepsOfDiggingTravelInOneMessage) {
    EXPECT_LE(base::encoded(digging()).size(), lockstep::FrameBarrier::kOneMessage - sizeof(std::uint32_t));
}

TEST(FrameMessage, RefusesEveryTruncation) {
    const base::Bytes bytes = base::encoded(observed());
    for (std::size_t length = 0; length < bytes.size(); ++length) {
        EXPECT_THROW((void)base::decoded<lockstep::FrameMessage>(std::span(bytes).first(length)), base::FormatError);
    }
}

TEST(SessionMessage, SurvivesItsEncoding) {
    using Fault = lockstep::Fault;
    const lockstep::SessionMessage message{
        {1, 2, 3},
        {4, 5},
        12.5,
        {{.kind = Fault::Kind::slow, .rank = 5, .frame = 7, .frames = 9, .milliseconds = 30},
         {.kind = Fault::Kind::diverge, .rank = 0, .frame = 99, .column = 7, .row = 8, .bit = 9},
         {.kind = Fault::Kind::die, .rank = 2, .signal = 11},
         {.kind = Fault::Kind::partition, .rank = Fault::kLink, .frame = 3, .milliseconds = 1}},
        true,
        "dunes",
        true};
    const lockstep::SessionMessage copy = base::decoded<lockstep::SessionMessage>(base::encoded(message));
    EXPECT_EQ(copy.scene, message.scene);
    EXPECT_EQ(copy.wall, message.wall);
    EXPECT_EQ(copy.frameTimeout, 12.5);
    EXPECT_EQ(copy.faults, message.faults);
    EXPECT_TRUE(copy.pointer);
    EXPECT_EQ(copy.sceneName, "dunes");
    EXPECT_TRUE(copy.resumes);
}

}  // namespace
