// SPDX-License-Identifier: Apache-2.0
#include "tracking/opentrack.hpp"

#include <limits>

#include "tests/tracking/tracking_samples.hpp"
#include "tracking/room_mapping.hpp"

namespace {

using namespace tracking;
using test::near;

Reading read(const base::Bytes& packet) { return OpentrackReader().read(packet, false); }

TEST(Opentrack, TellsCentimetresAndDegrees) {
    // 30 cm to the user's left, 10 cm up, 50 cm away from the screen.
    const Reading reading = read(test::doubles({30, 10, 50, 0, 0, 0}));
    ASSERT_EQ(reading.kind, Reading::Kind::pose);
    EXPECT_TRUE(near(reading.measured.position, {-0.3, 0.1, 0.5}));
    EXPECT_EQ(reading.measured.rotation, glm::dmat3(1.0));
}

TEST(Opentrack, CountsYawToTheRight) {
    // With the head turned to the right by 30 degrees, the right eye is farther from the wall: sin 30° = 1/2.
    const Reading reading = read(test::doubles({0, 0, 0, 30, 0, 0}));
    EXPECT_TRUE(near(reading.measured.rotation[0], {std::sqrt(0.75), 0, 0.5}));
}

TEST(Opentrack, CountsPitchUpAndRollToTheLeft) {
    EXPECT_TRUE(near(-read(test::doubles({0, 0, 0, 0, 30, 0})).measured.rotation[2], {0, 0.5, -std::sqrt(0.75)}));
    EXPECT_TRUE(near(read(test::doubles({0, 0, 0, 0, 0, 30})).measured.rotation[0], {std::sqrt(0.75), 0.5, 0}));
}

TEST(Opentrack, IsLittleEndian) {
    // 1.0 is 3f f0 00 00 00 00 00 00, written from its last byte.
    base::Bytes packet(48, 0);
    packet[15] = 0x3f;
    packet[14] = 0xf0;
    EXPECT_TRUE(near(read(packet).measured.position, {0, 0.01, 0}));
}

TEST(Opentrack, RefusesEveryOtherLength) {
    const base::Bytes good = test::doubles({0, 0, 0, 0, 0, 0});
    ASSERT_EQ(read(good).kind, Reading::Kind::pose);
    for (const std::size_t size : {0U, 1U, 47U, 49U, 56U, 65507U}) {
        EXPECT_EQ(read(base::Bytes(size, 0)).kind, Reading::Kind::refused) << size;
    }
}

TEST(Opentrack, RefusesWhatNoHeadDoes) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinite = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 6; ++i) {
        for (const double absurd : {nan, infinite, -infinite, 10'001.0, -1e300}) {
            std::vector<double> values(6, 0);
            values[i] = absurd;
            EXPECT_EQ(read(test::doubles(values)).kind, Reading::Kind::refused) << i << ": " << absurd;
        }
    }
    EXPECT_EQ(read(test::doubles({10'000, 0, 0, 360, -360, 0})).kind, Reading::Kind::pose) << "just not absurd";
}

TEST(Opentrack, IsSentAsItIsRead) {
    const Pose pose{{0.2, -0.1, 0.7}, glm::normalize(glm::dvec3(0.9, 0.2, -0.3))};
    const Pose back = RoomMapping{}.pose(read(opentrackPacket(pose)).measured);
    EXPECT_TRUE(near(back.position, pose.position));
    EXPECT_TRUE(near(back.right, pose.right));
}

}  // namespace
