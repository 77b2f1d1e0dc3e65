// SPDX-License-Identifier: Apache-2.0
// The example of a driver, with a maker's library that logs each force (tests/haptic_bridge/devices/logging_maker.hpp).
#include <algorithm>
#include <sstream>

#include "haptic_bridge/devices/device_module.hpp"
#include "tests/support/processes/server_process.hpp"

namespace {

using test::eventually;

class ExampleDriver : public testing::Test {
protected:
    /// Returns the upward part of each force that the device got [N].
    [[nodiscard]] std::vector<double> forces() const {
        std::vector<double> all;
        std::istringstream rows(folder_.read("forces"));
        for (std::string row; std::getline(rows, row) && !rows.eof();) {
            double x = 0, y = 0, z = 0;
            std::istringstream(row) >> x >> y >> z;
            all.push_back(z);
        }
        return all;
    }
    [[nodiscard]] bool got(double force) const {
        const auto all = forces();
        return std::count(all.begin(), all.end(), force) > 0;
    }
    /// Pushes again and again, as the force loop does, until the device gets the force.
    [[nodiscard]] bool pushUntilGot(double force) {
        return eventually([&] {
            arm_->push({0, 0, force});
            return got(force);
        });
    }

    const test::Folder folder_{};
    std::unique_ptr<haptic_bridge::Arm> arm_ =
        haptic_bridge::openArmModule(SANDWALL_BIN_DIR "/logging-example.so:" + folder_.file("forces"));
};

TEST_F(ExampleDriver, SendsZeroWhileTheForceLoopStandsStillAndGoesOnAfterwards) {
    for (const double force : {1.0, 2.0}) {
        ASSERT_TRUE(pushUntilGot(force));
        EXPECT_TRUE(eventually([this] { return forces().back() == 0; })) << "without a push of 0";
    }
}

TEST_F(ExampleDriver, LeavesTheDeviceWithZero) {
    ASSERT_TRUE(pushUntilGot(1));
    arm_.reset();
    EXPECT_EQ(forces().back(), 0);
}

}  // namespace
