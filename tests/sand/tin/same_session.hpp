// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "sand/replica.hpp"
#include "scene/model/scene.hpp"

namespace tin_samples {

/// Plays a session on two equal scenes, and on a replica that loads the whole state at every step that `joins`
/// divides. After each step, all replicas must have the same sand, and no sand may be lost.
inline void expectSameSession(const scene::Scene& scene, const scene::Scene& alike,
                              const std::vector<sand::Step>& steps, std::uint64_t joins) {
    sand::Replica whole(scene), again(alike), joined(scene);
    const std::int64_t volume = whole.volume();
    for (const sand::Step& step : steps) {
        whole.apply(step);
        again.apply(step);
        ASSERT_EQ(whole.stateHash(), again.stateHash()) << "step " << step.number;
        ASSERT_EQ(whole.volume() + whole.outflow(), volume) << "step " << step.number;
        if (step.number % joins == 0) {
            joined.decodeState(whole.encodeState());
        } else if (step.number > joins) {
            joined.apply(step);
        }
        if (step.number >= joins) {
            ASSERT_EQ(joined.stateHash(), whole.stateHash()) << "step " << step.number;
            ASSERT_EQ(joined.canUndo(), whole.canUndo()) << "step " << step.number;
        }
    }
    EXPECT_EQ(joined.encodeState(), whole.encodeState());
}

}  // namespace tin_samples
