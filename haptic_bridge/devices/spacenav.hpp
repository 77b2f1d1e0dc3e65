// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <string>
#include <thread>

#include "haptic_bridge/hand/device.hpp"

namespace haptic_bridge {

/// A six-axis mouse through libspnav and its daemon. How far the cap is pushed says how fast the hand goes; the first
/// button touches, the second brings the hand back to the centre, over the sand.
///
/// The library is loaded when this is made, and never before. A thread of the device's own asks it for news.
class SpacenavDevice : public Device {
public:
    static constexpr double kFullDeflection = 350;  // as the daemon counts
    static constexpr double kSpeed = 1.0;           // [half side/s] at full deflection
    static constexpr double kClimb = 6.0;           // [tool radius/s]

    /// Throws base::InputError when library or daemon is missing.
    explicit SpacenavDevice(const std::string& library = "libspnav.so.0");
    ~SpacenavDevice() override;

    [[nodiscard]] Pose read(double time) override;
    void sendForce(sand::force::Vec3) override {}
    [[nodiscard]] bool finished(double) const override { return false; }

private:
    struct Library;
    void listen();

    const Library* library_;
    std::array<std::atomic<int>, 3> push_{};  // to the right, up, away, as the library has its axes
    std::atomic<bool> touches_{false};
    std::atomic<int> homings_{0};
    Pose pose_;
    double time_ = 0;
    int homed_ = 0;
    std::atomic<bool> stopping_{false};
    std::thread thread_;
};

}  // namespace haptic_bridge
