// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/link/silence.hpp"

#include <gtest/gtest.h>

namespace {

using haptic_bridge::Silence;

constexpr std::uint64_t kPart = Silence::kLeastBytes;

// A load of hundreds of MiB on a slow network: the Pings of the master wait behind it.
TEST(Silence, EndsWithEachPartOfALongMessage) {
    Silence silence(100);
    EXPECT_EQ(silence.lengthNs(130), 30);
    silence.arrived(kPart, 130);
    EXPECT_EQ(silence.lengthNs(150), 20);
    silence.arrived(2 * kPart + 7, 150);
    EXPECT_EQ(silence.lengthNs(155), 5);
}

TEST(Silence, OfAPeerThatStopsInTheMiddleOfAMessageGoesOn) {
    Silence silence(100);
    silence.arrived(kPart, 130);
    silence.arrived(kPart, 140);
    silence.arrived(kPart, 190);
    EXPECT_EQ(silence.lengthNs(200), 70);
    silence.heard(200);
    EXPECT_EQ(silence.lengthNs(210), 10);
}

// Such a peer could hold a grant without an end, and no other master could take its place.
TEST(Silence, GoesOnWhileSingleBytesArrive) {
    Silence silence(100);
    for (std::uint64_t byte = 1; byte < kPart; ++byte) {
        silence.arrived(byte, 100 + static_cast<std::int64_t>(byte));
    }
    EXPECT_EQ(silence.lengthNs(100'000), 99'900);
    silence.arrived(kPart, 100'000);
    EXPECT_EQ(silence.lengthNs(100'000), 0) << "in the end they are as many as of a long message";
}

}  // namespace
