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

/// A hand for users without a haptic arm. A window shows the sand from above. The left button touches the sand, the
/// wheel sets the depth, and an arrow shows the force.
///
/// The device's own thread draws about 30 times per second. The force loop and the sand thread never wait for it. When
/// the user closes the window, the device counts as absent.
class MouseDevice : public Device, public SandWatcher {
public:
    using OpenWindow = std::function<std::unique_ptr<PictureWindow>()>;

    /// Calls `open` on the device's thread. Throws what `open` throws.
    explicit MouseDevice(const OpenWindow& open);
    ~MouseDevice() override;

    [[nodiscard]] Pose read(double time) override;
    void sendForce(sand::force::Vec3 force) override;
    [[nodiscard]] bool finished(double) const override { return false; }
    [[nodiscard]] const TroubleCounts* troubles() const override { return &troubles_; }
    [[nodiscard]] SandWatcher* watcher() override { return this; }
    void stepped(const sand::Replica& terrain) override;
    /// Sets the share of the force that is shown. Keys in the window do the same: f switches it on and off, + and -
    /// change it by a tenth.
    void shareForce(double share) override { share_ = share; }

private:
    void run(PictureWindow& window);
    void follow(const WindowInput& input);

    struct Hand {
        Pose pose;
        bool open = true;
    };
    base::TripleBuffer<Hand> hand_;                // from window to force loop
    base::TripleBuffer<sand::force::Vec3> force_;  // from force loop to window
    base::TripleBuffer<SandSketch> sketch_;        // from sand thread to window
    std::atomic<double> share_{1};
    TroubleCounts troubles_;
    std::int64_t sketchedNs_ = 0;  // [ns], of the last sketch; used by the sand thread
    // For the window's thread.
    SketchedHand shown_;
    double wheel_ = 0;
    std::atomic<bool> stopping_{false};
    std::thread thread_;
};

}  // namespace haptic_bridge
