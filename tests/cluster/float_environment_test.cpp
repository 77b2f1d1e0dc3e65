// SPDX-License-Identifier: Apache-2.0
#include "tests/cluster/session_fixture.hpp"

namespace {

using FloatEnvironment = SessionTest;

// The driver changes the rounding of its rank at the start and in every frame (tests/support/rough_driver.cpp).
TEST_F(FloatEnvironment, ADriverThatChangesItIsReportedAndTheSandStaysTheSame) {
    environment_ = {"LD_PRELOAD=" + support::linkTo("rough-driver.so", folder_), "SANDWALL_ROUGH_RANK=2",
                    "SANDWALL_EVENTS=1"};
    const Ended ended = runToEnd({"--wall", wall(1, 2, "mono"), "--scene", scene(), "--device", "script:gis", "--pace",
                                  "fast", "--steps", "300", "--out", out(), "--no-pictures"});
    ASSERT_EQ(ended.status, 0) << ended.output;
    EXPECT_TRUE(ended.has("floats", {{"rank", 2}})) << ended.output;
    EXPECT_FALSE(ended.has("floats", {{"rank", 1}})) << ended.output;
    EXPECT_EQ(summary()["divergences"], 0);
    EXPECT_EQ(summary()["healed"], 0);
    EXPECT_EQ(summary()["steps"], 300);
    EXPECT_EQ(summary()["state_hash"], replayedHash());
}

}  // namespace
