// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "scene/model/scene.hpp"
#include "tests/haptic_bridge/loop/push_check.hpp"
#include "tests/haptic_bridge/loop/strong_arm.hpp"
#include "tests/haptic_bridge/loop/virtual_server.hpp"
#include "tests/support/hand/arm_on_sand.hpp"

namespace test {

inline constexpr double kToolInArm = 0.006;  // [m], of the tool, in metres of the arm

/// A server with a strong arm over level sand, under a virtual clock. Every push of the arm is checked.
class GuardedServer : public testing::Test {
protected:
    /// Begins a server. Ends and checks the one before.
    void open(LoggingArm::Path path, double ceiling = 1, const std::vector<std::string>& map = {}) {
        endAndCheck();
        server_ = std::make_unique<VirtualServer>(scene_, strongArm(), std::move(path), ceiling,
                                                  haptic_bridge::HandSettings::parse(map));
    }
    void TearDown() override { endAndCheck(); }
    /// Ends the server, and checks all of its pushes.
    void endAndCheck() {
        if (!server_) {
            return;
        }
        const haptic_bridge::ForceLimits limits = server_->hand().guards().limits();
        server_->end();
        PushCheck check(limits);
        for (const Push& push : server_->pushes) {
            const std::string wrong = check.wrong(push.force);
            ASSERT_EQ(wrong, "") << "at " << push.time << " s";
        }
        EXPECT_EQ(norm(server_->pushed()), 0) << "the last push";
        server_.reset();
    }
    [[nodiscard]] double force() const { return norm(server_->pushed()); }
    /// Returns the greatest force of the last `seconds` [s].
    [[nodiscard]] double greatest(double seconds) const {
        double most = 0;
        for (std::size_t i = server_->pushes.size() - static_cast<std::size_t>(seconds * 1000);
             i < server_->pushes.size(); ++i) {
            most = std::max(most, norm(server_->pushes[i].force));
        }
        return most;
    }
    /// Calls `check` with each law, and each way between two surfaces. The law's largest force is `most` [N].
    template <class Check>
    void forEachLaw(double most, const Check& check) {
        for (const auto law : {sand::ForceLaw::repulse, sand::ForceLaw::controlPoints}) {
            for (const auto& [between, name] : valuesOf(sand::Between{})) {
                SCOPED_TRACE(std::string(name) + (law == sand::ForceLaw::repulse ? ", repulse" : ", control points"));
                scene_.force.law = law;
                scene_.force.maxForce = most;
                scene_.force.between = between;
                check();
            }
        }
    }
    /// Returns the tuning of the sand with another talus [deg].
    [[nodiscard]] sand::Edit talus(double degrees) const {
        sand::Tuning tuning = server_->sand().rules().tuning;
        tuning.threshold = tuning.startThreshold =
            static_cast<std::int32_t>(std::lround(std::tan(degrees * std::numbers::pi / 180) * sand::kUnitsPerCell));
        return sand::Edit::tuned(tuning);
    }
    /// Returns the edit that gives the tool `share` of its radius.
    [[nodiscard]] sand::Edit toolOf(double share) const {
        sand::Tuning tuning = server_->sand().rules().tuning;
        tuning.tool.radius = static_cast<std::int32_t>(std::lround(share * tuning.tool.radius));
        return sand::Edit::tuned(tuning);
    }
    /// Returns the edit that loads level sand of `height` [cell].
    [[nodiscard]] sand::Edit levelAt(int height) const {
        scene::Scene level = scene_;
        for (int y = 0; y < level.rules.rows; ++y) {
            for (int x = 0; x < level.rules.columns; ++x) {
                level.terrain.setHeight(x, y, height * sand::kUnitsPerCell);
            }
        }
        return sand::Edit::loaded(sand::Replica(level).copySand()->encode());
    }

    scene::Scene scene_ = levelSand({}, 128, 0.25);
    std::unique_ptr<VirtualServer> server_;
};

}  // namespace test
