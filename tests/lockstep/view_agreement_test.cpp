// SPDX-License-Identifier: Apache-2.0
#include "lockstep/view_agreement.hpp"

#include <gtest/gtest.h>

namespace {

using lockstep::ViewProof;
using lockstep::ViewState;

const base::Bytes kWall{1, 2, 3};

ViewState seen() {
    return {.head = {0.1, 1.6, 2.5},
            .right = {1, 0, 0},
            .eyeSeparation = 0.065,
            .sceneToRoom = {},
            .pattern = 0,
            .layers = {}};
}

TEST(ViewAgreement, EveryPartOfAViewCounts) {
    const ViewProof proof(kWall);
    const std::uint64_t hash = proof.hash(seen());
    EXPECT_EQ(proof.hash(seen()), hash);
    ViewState other = seen();
    other.head[2] += 1e-9;
    EXPECT_NE(proof.hash(other), hash);
    other = seen();
    other.right[1] = 1e-9;
    EXPECT_NE(proof.hash(other), hash);
    other = seen();
    other.eyeSeparation = 0.064;
    EXPECT_NE(proof.hash(other), hash);
    other = seen();
    other.sceneToRoom[15] = 2;
    EXPECT_NE(proof.hash(other), hash);
    other = seen();
    other.pattern = 3;
    EXPECT_NE(proof.hash(other), hash);
    other = seen();
    other.layers.set(lockstep::Overlay::force, true);
    EXPECT_NE(proof.hash(other), hash);
    other = seen();
    other.stereo = 1;
    EXPECT_NE(proof.hash(other), hash);
    other = seen();
    other.humidity = 0.1;
    EXPECT_NE(proof.hash(other), hash);
    other = seen();
    other.window[1] = 720;
    EXPECT_NE(proof.hash(other), hash);
}

TEST(ViewAgreement, AnotherWallIsAnotherView) {
    EXPECT_NE(ViewProof(kWall).hash(seen()), ViewProof(base::Bytes{1, 2, 4}).hash(seen()));
}

TEST(ViewAgreement, WhoDiffersIsNamed) {
    std::vector<lockstep::Arrival> arrivals(3);
    for (lockstep::Arrival& arrival : arrivals) {
        arrival.frame = 7;
        arrival.viewHash = 5;
    }
    const std::vector<std::string> names{"the master", "rank 1 (tile a) on x", "rank 2 (tile b) on y"};
    EXPECT_TRUE(lockstep::describeOtherViews(arrivals, names).empty());
    arrivals[2].viewHash = 6;
    const std::vector<std::string> lines = lockstep::describeOtherViews(arrivals, names);
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_TRUE(lines[0].starts_with("frame 7: rank 2 (tile b) on y drew another view")) << lines[0];
}

}  // namespace
