// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <thread>

#include "base/triple_buffer.hpp"
#include "haptic_bridge/devices/picture_window.hpp"
#include "haptic_bridge/devices/sand_picture.hpp"
#include "haptic_bridge/devices/sand_watcher.hpp"
#include "haptic_bridge/hand/device.hpp"
#include "haptic_bridge/hand/device_troubles.hpp"

namespace haptic_bridge {

/// A hand for whoever has no haptic arm: a window shows the sand from above; the left button touches, the wheel sets
/// how deep, and the force is an arrow.
///
/// A thread of its own draws about 30 times a second; neither the force loop nor the sand thread ever waits for it. A
/// window that was closed is an absent device.
class MouseDevice : public Device, public SandWatcher {
public:
    using OpenWindow = std::function<std::unique_ptr<PictureWindow>()>;

    /// Throws what `open` throws, which is called on the device's thread.
    explicit MouseDevice(const OpenWindow& open);
    ~MouseDevice() override;

    [[nodiscard]] Pose read(double time) override;
    void sendForce(sand::force::Vec3 force) override;
    [[nodiscard]] bool finished(double) const override { return false; }
    [[nodiscard]] const TroubleCounts* troubles() const override { return &troubles_; }
    [[nodiscard]] SandWatcher* watcher() override { return this; }
    void stepped(const sand::Replica& terrain) override;
    /// Also by keys in the window: f all or nothing, + and - a tenth more or less.
    void shareForce(double share) override { share_ = share; }

private:
    void run(PictureWindow& window);
    void follow(const WindowInput& input);

    struct Hand {
        Pose pose;
        bool open = true;
    };
    base::TripleBuffer<Hand> hand_;                // window to force loop
    base::TripleBuffer<sand::force::Vec3> force_;  // force loop to window
    base::TripleBuffer<SandSketch> sketch_;        // sand to window
    std::atomic<double> share_{1};
    TroubleCounts troubles_;
    std::int64_t sketchedNs_ = 0;  // the sand thread's
    // The window's thread.
    SketchedHand shown_;
    double wheel_ = 0;
    std::atomic<bool> stopping_{false};
    std::thread thread_;
};

}  // namespace haptic_bridge
