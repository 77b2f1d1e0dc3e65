// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <string>
#include <thread>

#include "haptic_bridge/hand/device.hpp"

namespace haptic_bridge {

/// A six-axis mouse, used through libspnav and its daemon. The farther the user pushes the cap, the faster the hand
/// moves. The first button touches the sand. The second button brings the hand back to the centre, over the sand.
///
/// The constructor loads the library; no other code loads it. The device's own thread polls it for events.
class SpacenavDevice : public Device {
public:
    static constexpr double kFullDeflection = 350;  // [unit of the daemon]
    static constexpr double kSpeed = 1.0;           // [half side/s] at full deflection
    static constexpr double kClimb = 6.0;           // [tool radius/s] at full deflection

    /// Throws base::InputError if the library or the daemon is missing.
    explicit SpacenavDevice(const std::string& library = "libspnav.so.0");
    ~SpacenavDevice() override;

    [[nodiscard]] Pose read(double time) override;
    void sendForce(sand::force::Vec3) override {}
    [[nodiscard]] bool finished(double) const override { return false; }

private:
    struct Library;
    void listen();

    const Library* library_;
    std::array<std::atomic<int>, 3> push_{};  // right, up and away from the user, in the library's axes
    std::atomic<bool> touches_{false};
    std::atomic<int> homings_{0};
    Pose pose_;
    double time_ = 0;
    int homed_ = 0;
    std::atomic<bool> stopping_{false};
    std::thread thread_;
};

}  // namespace haptic_bridge
