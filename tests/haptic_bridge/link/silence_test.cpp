// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/link/silence.hpp"

#include <gtest/gtest.h>

namespace {

using haptic_bridge::Silence;

// A load of hundreds of MiB on a slow network: the Pings of the master wait behind it.
TEST(Silence, EndsWithEachPartOfALongMessage) {
    Silence silence(100);
    EXPECT_EQ(silence.lengthNs(130), 30);
    silence.arrived(64, 130);
    EXPECT_EQ(silence.lengthNs(150), 20);
    silence.arrived(65, 150);
    EXPECT_EQ(silence.lengthNs(155), 5);
}

TEST(Silence, OfAPeerThatStopsInTheMiddleOfAMessageGoesOn) {
    Silence silence(100);
    silence.arrived(64, 130);
    silence.arrived(64, 140);
    silence.arrived(64, 190);
    EXPECT_EQ(silence.lengthNs(200), 70);
    silence.heard(200);
    EXPECT_EQ(silence.lengthNs(210), 10);
}

}  // namespace
