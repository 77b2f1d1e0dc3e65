// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <vector>

#include "master/steps/live_steps.hpp"
#include "tests/haptic_bridge/client/sand_server.hpp"
#include "tests/support/processes/server_process.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace test {

using master::ArrivedStep;

inline constexpr std::int64_t kFrameNs = 16'666'667;
inline constexpr std::chrono::milliseconds kLooks{1200};  // time in which a link looks at its clock twice

/// A wall without ranks. It shows each step that it takes.
class LiveStepsTest : public testing::Test {
protected:
    master::LiveSteps stepsFrom(const haptic_bridge::Address& server) {
        return {server, scene_, asked_, haptic_bridge::Pace::fast, 0, {}, [this] { return nowNs_.load(); }};
    }
    void pass(double seconds) { nowNs_ += static_cast<std::int64_t>(seconds * 1e9); }
    /// Shows one frame, and returns its steps.
    std::vector<ArrivedStep> show(master::LiveSteps& live, std::size_t most = 4) {
        std::vector<ArrivedStep> steps = live.next(wall_, wall_.stateHash(), most);
        for (const ArrivedStep& timed : steps) {
            wall_.apply(timed.step);
            if (wall_.refusedStep()) {
                live.refused(steps, wall_.leftOut());
            }
            if (timed.step.edit.any()) {
                edits_.push_back(timed.step.edit);
            }
        }
        live.shown({wall_.stepNumber(), kFrameNs});
        differed_ += live.proveServer(steps, wall_.stateHash()) ? 0 : 1;
        return steps;
    }
    template <class Done>
    bool showUntil(master::LiveSteps& live, const Done& done) {
        return eventually([&] {
            show(live);
            return done();
        });
    }
    /// Returns whether the master numbers the steps.
    bool numbersAlone(master::LiveSteps& live) {
        const std::vector<ArrivedStep> steps = show(live);
        return !live.linked() && steps.size() == 1 && steps[0].serverHash == 0 && steps[0].step.epoch == live.epoch();
    }
    static std::uint64_t refusedForSilence(const master::LiveSteps& live) {
        return live.counters().refused[static_cast<std::size_t>(haptic_bridge::RefusalCode::limit) - 1];
    }

    const scene::Scene scene_ = samples::flatScene(32, 24);
    sand::Replica wall_{scene_};
    std::atomic<std::int64_t> nowNs_{1'000'000'000};
    int differed_ = 0;
    master::Edits asked_;
    std::vector<sand::Edit> edits_;  // of the steps that were shown
};

}  // namespace test
