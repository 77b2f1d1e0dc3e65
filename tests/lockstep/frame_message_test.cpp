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
                                   .steps = {}};
    message.view.layers.set(lockstep::Layer::hillShade, true);
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
    EXPECT_EQ(lockstep::FrameMessage::decode(message.encode()), message);
}

TEST(FrameMessage, EightStepsOfDiggingTravelInOneMessage) {
    EXPECT_LE(digging().encode().size(), lockstep::FrameBarrier::kOneMessage - sizeof(std::uint32_t));
}

TEST(FrameMessage, RefusesEveryTruncation) {
    const files::Bytes bytes = digging().encode();
    for (std::size_t length = 0; length < bytes.size(); ++length) {
        EXPECT_THROW((void)lockstep::FrameMessage::decode(std::span(bytes).first(length)), files::FormatError);
    }
}

TEST(SessionMessage, SurvivesItsEncoding) {
    const lockstep::SessionMessage message{
        {1, 2, 3}, {4, 5}, 12.5, lockstep::BitFlip{3, 99, 7, 8}, lockstep::SkewedView{2, 98}, 4};
    const lockstep::SessionMessage copy = lockstep::SessionMessage::decode(message.encode());
    EXPECT_EQ(copy.scene, message.scene);
    EXPECT_EQ(copy.wall, message.wall);
    EXPECT_EQ(copy.frameTimeout, 12.5);
    ASSERT_TRUE(copy.fault.has_value());
    EXPECT_EQ(copy.fault->frame, 99U);
    EXPECT_EQ(copy.fault->row, 8);
    ASSERT_TRUE(copy.skew.has_value());
    EXPECT_EQ(copy.skew->rank, 2);
    EXPECT_EQ(copy.skew->frame, 98U);
    EXPECT_EQ(copy.spoiltShader, 4);
}

}  // namespace
