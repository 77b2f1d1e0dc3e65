// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>

#include "haptic_bridge/hand/device.hpp"
#include "haptic_bridge/hand/device_troubles.hpp"
#include "haptic_bridge/hand/hand_settings.hpp"
#include "scene/scene.hpp"

namespace haptic_bridge {

/// Lays an arm over the sand: metres in its own axes become hand space, and forces go back the same way.
///
/// A force is felt as it is, in newtons at the hand: the scale changes how far the hand goes for it, so the limits of
/// stiffness and damping hold after the scale. It goes back through the transpose of the mapping, so that a force which
/// does no work on a closed path of the tool does none on the hand's either; where the vertical has a scale of its own,
/// the weaker direction is shortened. While the second button is held, the tool stays where it is and the hand moves
/// away under it. With a drift the middle of the workspace slowly comes to where the hand works, while nothing is felt.
class MappedDevice : public Device {
public:
    static constexpr double kRampSeconds = 0.5;    // from no force to all of it
    static constexpr double kFadeSeconds = 0.05;   // and back, when the hand is in order
    static constexpr double kFarthestShare = 0.5;  // [reach], of a movement between two readings

    /// The arm over this scene. Throws base::InputError for settings that an arm cannot have.
    MappedDevice(std::unique_ptr<Arm> arm, const HandSettings& settings, const scene::Scene& scene);

    /// [scene unit/m] that an arm gets over this scene.
    [[nodiscard]] static double scaleFor(const ArmPhysics& arm, const HandSettings& settings,
                                         const scene::Scene& scene);

    [[nodiscard]] Pose read(double time) override;
    void sendForce(sand::force::Vec3 force) override;
    [[nodiscard]] const ArmPhysics* physics() const override { return &arm_->physics(); }
    [[nodiscard]] double scale() const override;
    [[nodiscard]] bool finished(double) const override { return false; }
    [[nodiscard]] ArmReading reading() const override { return reading_; }
    [[nodiscard]] const TroubleCounts* troubles() const override { return &troubles_; }
    void shareForce(double share) override { share_ = share; }

private:
    [[nodiscard]] sand::force::Vec3 turned(sand::force::Vec3 place) const;
    void moveOrigin(const ArmReading& reading, sand::force::Vec3 place);
    void rampForce(double seconds, double wanted);

    std::unique_ptr<Arm> arm_;
    HandSettings settings_;
    double scale_;                  // [scene unit/m], of the horizontal
    double horizontal_, vertical_;  // hand space per metre
    sand::force::Vec3 origin_;      // [m], east, north, up: over the field's centre
    TroubleCounts troubles_;
    ReadingCheck check_;
    std::atomic<double> share_{1};  // of the force that is asked for, 0 to 1
    Pose pose_;
    ArmReading reading_;      // the last that could be believed, and whether this one could
    sand::force::Vec3 last_;  // [m], its place: east, north, up
    bool known_ = false, feels_ = false;
    double time_ = 0, gain_ = 0;
};

}  // namespace haptic_bridge
