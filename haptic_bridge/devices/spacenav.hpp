// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string>
#include <thread>

#include "haptic_bridge/hand/device.hpp"
#include "haptic_bridge/hand/device_troubles.hpp"

namespace haptic_bridge {

struct SpnavLibrary;

/// A six-axis mouse, used through libspnav and its daemon. The farther the user pushes the cap, the faster the hand
/// moves. The first button touches the sand. The second button brings the hand back to the centre, over the sand.
///
/// The device is absent from when its daemon ends, hangs or reports that the mouse is unplugged, until it is back. The
/// tool then stops and is lifted, and the cap and the buttons count as released.
///
/// The constructor loads the library; no other code loads it. The device's own thread polls it for events, and links
/// it again when the daemon has ended.
class SpacenavDevice : public Device {
public:
    static constexpr double kFullDeflection = 350;  // [unit of the daemon]
    static constexpr double kSpeed = 1.0;           // [half side/s] at full deflection
    static constexpr double kClimb = 6.0;           // [tool radius/s] at full deflection

    // The daemon sends an event when the cap moves. A cap that is held still may send none for minutes. So a silent
    // daemon is asked, and hangs if it does not answer.
    static constexpr double kAskAfter = 0.1;  // [s] of silence, while the cap is pushed or the first button is down
    static constexpr double kPatience = 0.5;  // [s] of silence, after which a daemon that was asked hangs
    // A daemon before 1.0 answers no question. At full push, the hand moves half a side of the field in this time.
    static constexpr double kPatienceUnasked = 1;                  // [s] of silence, while the cap is pushed
    static constexpr double kFirstRetry = 0.02, kLastRetry = 1.0;  // [s] between attempts to link the daemon again

    /// `library` is a file or a name of the library; empty: that of Debian. Throws base::InputError if the library or
    /// the daemon is missing.
    explicit SpacenavDevice(const std::string& library = "");
    ~SpacenavDevice() override;

    [[nodiscard]] Pose read(double time) override;
    void sendForce(sand::force::Vec3) override {}
    [[nodiscard]] bool finished(double) const override { return false; }
    [[nodiscard]] ArmReading reading() const override { return reading_; }
    [[nodiscard]] const TroubleCounts* troubles() const override { return &troubles_; }

private:
    void listen();
    void tryToLink();
    [[nodiscard]] bool takeEvents();
    void takeEvent();
    void watchSilence();
    void lose();

    const SpnavLibrary* library_;
    // From the device's thread to the thread that reads.
    std::array<std::atomic<int>, 3> push_{};  // right, up and away from the user, in the library's axes
    std::atomic<bool> touches_{false};
    std::atomic<int> homings_{0};
    std::atomic<bool> present_{true};
    std::atomic<std::uint64_t> losses_{0};  // so that no short absence is missed

    // Used by the device's thread.
    bool linked_ = false, asked_ = false, unplugged_ = false;
    std::int64_t heardNs_ = 0, triedNs_ = 0;
    double retry_ = kFirstRetry;  // [s] from triedNs_ to the next attempt

    // Used by the thread that reads.
    Pose pose_;
    ArmReading reading_;
    TroubleCounts troubles_;
    double time_ = 0;
    int homed_ = 0;
    std::uint64_t seenLosses_ = 0;

    std::atomic<bool> stopping_{false};
    std::thread thread_;
};

}  // namespace haptic_bridge
