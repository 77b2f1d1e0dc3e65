// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "haptic_bridge/hand/device.hpp"
#include "haptic_bridge/hand/device_troubles.hpp"
#include "haptic_bridge/hand/hand_settings.hpp"
#include "scene/model/scene.hpp"

namespace haptic_bridge {

/// An arm that is mapped to the sand: metres along its own axes become hand space, and forces go back the same way.
///
/// The scale only changes how far the tool moves; it does not change a force [N]. The limits of stiffness and damping
/// therefore hold after the scale. Forces go back through the transpose of the mapping. A force that does no work on a
/// closed path of the tool then does no work on the hand's path either. There is one exception: if the vertical has a
/// scale of its own, the force along the direction with the smaller scale is reduced.
///
/// After an implausible reading the tool hovers at its last place, and reading() is absent until a reading is
/// plausible. While the arm gives no reading, the tool hovers, too, and answers() is false.
///
/// While the second button is held, the tool keeps its place, and the hand moves freely. With a drift, the middle of
/// the workspace moves slowly to where the hand works, while the hand feels no force.
class MappedDevice : public Device {
public:
    /// So many readings in a row may be missing before the arm counts as absent. It may only be late until then.
    static constexpr int kMayBeLate = 10;
    static constexpr double kFarthestShare = 0.5;  // [share of the reach], largest movement between two readings

    /// Throws base::InputError for settings that an arm cannot have. Call it before an arm is opened, so that bad input
    /// does not touch the arm.
    static void requireSettingsOfAnArm(const HandSettings& settings);

    /// Maps `arm` to `scene`. Requires what requireSettingsOfAnArm() does.
    MappedDevice(std::unique_ptr<Arm> arm, const HandSettings& settings, const scene::Scene& scene);

    /// Returns the scale of `arm` over `scene` [scene unit/m].
    [[nodiscard]] static double scaleFor(const ArmPhysics& arm, const HandSettings& settings,
                                         const scene::Scene& scene);

    [[nodiscard]] Pose read(double time) override;
    void sendForce(sand::force::Vec3 force) override;
    [[nodiscard]] const ArmPhysics* physics() const override { return &arm_->physics(); }
    [[nodiscard]] double scale() const override;
    [[nodiscard]] bool finished(double) const override { return false; }
    [[nodiscard]] ArmReading reading() const override { return reading_; }
    [[nodiscard]] bool answers() const override { return silent_ == 0; }
    [[nodiscard]] const TroubleCounts* troubles() const override { return &troubles_; }

private:
    [[nodiscard]] sand::force::Vec3 turned(sand::force::Vec3 place) const;
    void moveOrigin(const ArmReading& reading, sand::force::Vec3 place);

    std::unique_ptr<Arm> arm_;
    HandSettings settings_;
    double scale_;                  // [scene unit/m], horizontal scale
    double horizontal_, vertical_;  // [hand space/m]
    sand::force::Vec3 origin_;      // [m], east, north, up: place of the arm over the field's centre
    TroubleCounts troubles_;
    ReadingCheck check_;
    Pose pose_;
    ArmReading reading_;      // the last plausible reading; `present` is that of the latest
    sand::force::Vec3 last_;  // [m], place of reading_: east, north, up
    bool known_ = false, feels_ = false;
    int silent_ = 0;  // number of readings in a row that are missing, at most one more than kMayBeLate
};

}  // namespace haptic_bridge
