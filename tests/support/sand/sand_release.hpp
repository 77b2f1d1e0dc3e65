// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <vector>

#include "sand/replica.hpp"
#include "scene/model/scene.hpp"

/// Sand that a tool holds back, and ways to release it.
namespace release {

/// Returns the south-west corner of a cell, at a height [cell].
inline sand::ProbePoint cellAt(int column, int row, int height) {
    return {column * sand::kProbePerCell, row * sand::kProbePerCell, height * sand::kProbePerCell};
}

/// Presses a tool into the sand at `probe`, and holds it until the sand around it is at rest.
inline void hold(sand::Replica& replica, const sand::ProbePoint& probe) {
    replica.apply({1, replica.stepNumber() + 1, true, {probe}});
    while (!replica.settled() && replica.stepNumber() < 5000) {
        replica.apply({1, replica.stepNumber() + 1, true, {}});
    }
    ASSERT_TRUE(replica.settled());
}

/// First step of a hand whose tool was held.
struct Way {
    const char* name;
    bool engaged;
    std::vector<sand::ProbePoint> path;
    std::optional<sand::Heading> heading;
};

/// Holds a tool at `probe`. Expects that the sand flows after each way as in a replica that has just joined. The joined
/// replica examines all sand, so that the sand that the tool held back flows there without a release. Each way lasts
/// `steps` steps. Sand must still move after the first `moving` of them.
inline void expectFlowsAsJoined(const scene::Scene& scene, const sand::ProbePoint& probe, const std::vector<Way>& ways,
                                int steps, int moving) {
    for (const Way& way : ways) {
        sand::Replica replica(scene), joined(scene);  // no copies, because the copy of a TIN examines all sand too
        ASSERT_NO_FATAL_FAILURE(hold(replica, probe)) << way.name;
        joined.decodeState(replica.encodeState());
        sand::Step step{1, replica.stepNumber() + 1, way.engaged, way.path};
        step.heading = way.heading;
        for (int i = 0; i < steps; ++i) {
            replica.apply(step);
            joined.apply(step);
            ASSERT_EQ(replica.stateHash(), joined.stateHash()) << way.name << ", step " << i;
            EXPECT_TRUE(i >= moving || !replica.settled()) << way.name << ", step " << i;
            step = {1, step.number + 1, way.engaged, {}};
        }
    }
}

}  // namespace release
