// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/devices/mapped_device.hpp"

#include <algorithm>
#include <utility>

#include "base/input_error.hpp"

namespace haptic_bridge {

using sand::force::Vec3;

namespace {

constexpr double kFittedShare = 0.8;  // of the field's shorter side, if no scale is given

double& part(Vec3& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

double halfSide(const scene::Scene& scene) {
    return std::min(scene.rules.columns, scene.rules.rows) * scene.terrain.cellSize() / 2;
}

}  // namespace

MappedDevice::MappedDevice(std::unique_ptr<Arm> arm, const HandSettings& settings, const scene::Scene& scene)
    : arm_(std::move(arm)),
      settings_(settings),
      scale_(scaleFor(arm_->physics(), settings, scene)),
      horizontal_(scale_ / halfSide(scene)),
      vertical_(scale_ * settings.verticalScale / scene.toolRadius()),
      origin_(settings.origin.value_or(Vec3{})),
      check_(kFarthestShare * arm_->physics().reach, troubles_) {
    requireSettingsOfAnArm(settings);
}

void MappedDevice::requireSettingsOfAnArm(const HandSettings& settings) {
    if (settings.datum == HandSettings::Datum::surface) {
        // On a slope such a mapping would bend the hand's space. A force in that space would do work on a closed path.
        throw base::InputError("--map datum=surface: works only for recordings; an arm needs datum=level");
    }
}

double MappedDevice::scaleFor(const ArmPhysics& arm, const HandSettings& settings, const scene::Scene& scene) {
    return settings.scale.value_or(kFittedShare * halfSide(scene) / arm.reach);
}

double MappedDevice::scale() const { return scale_ * std::max(1.0, settings_.verticalScale); }

Vec3 MappedDevice::turned(Vec3 place) const {
    const auto along = [&](const HandSettings::Axis& axis) { return axis.sign * part(place, axis.column); };
    return {along(settings_.axes[0]), along(settings_.axes[1]), along(settings_.axes[2])};
}

void MappedDevice::moveOrigin(const ArmReading& reading, Vec3 place) {
    const Vec3 moved = known_ ? place - last_ : Vec3{};
    if (reading.second) {
        origin_ = origin_ + moved;
    } else if (!feels_) {  // while a force acts, a moving origin would put energy into the hand
        const double share = settings_.drift * norm(moved) / arm_->physics().reach;
        origin_ = origin_ - share * Vec3{place.x, place.y, 0};
    }
}

Pose MappedDevice::read(double time) {
    const ArmReading reading = arm_->read(time);
    silent_ = reading.present ? 0 : std::min(silent_ + 1, kMayBeLate + 1);
    troubles_.answered(silent_ == 0 || (known_ && silent_ <= kMayBeLate));
    if (silent_ > 0) {
        reading_.present = false;
        Pose hovering = pose_;
        hovering.engaged = false;
        return hovering;  // pose_ stays, because the clutch keeps a stroke engaged
    }
    if (!check_.accept(time, reading.place)) {
        reading_.present = false;
        pose_.engaged = false;
        return pose_;
    }
    reading_ = reading;
    const Vec3 place = turned(reading.place);
    moveOrigin(reading, place);
    last_ = place;
    known_ = true;

    const Vec3 from = place - origin_;
    pose_.x = from.x * horizontal_;
    pose_.y = from.y * horizontal_;
    pose_.z = 1 - settings_.depth.value_or(0) + from.z * vertical_;
    switch (settings_.engage.value_or(HandSettings::Engage::always)) {
        case HandSettings::Engage::near:
            pose_.engaged = pose_.z < 2;
            break;
        case HandSettings::Engage::always:
            pose_.engaged = true;
            break;
        case HandSettings::Engage::button:
            // The clutch keeps the stroke engaged. Without that, releasing the touch button during the clutch would
            // lift the tool unnoticed.
            pose_.engaged = reading.second ? pose_.engaged : reading.first;
            break;
    }
    return pose_;
}

void MappedDevice::sendForce(Vec3 force) {
    feels_ = force.x != 0 || force.y != 0 || force.z != 0;
    const double vertical = settings_.verticalScale, longest = std::max(1.0, vertical);
    const Vec3 felt = (1 / longest) * Vec3{force.x, force.y, vertical * force.z};
    Vec3 pushed;
    part(pushed, settings_.axes[0].column) = settings_.axes[0].sign * felt.x;
    part(pushed, settings_.axes[1].column) = settings_.axes[1].sign * felt.y;
    part(pushed, settings_.axes[2].column) = settings_.axes[2].sign * felt.z;
    arm_->push(pushed);
}

}  // namespace haptic_bridge
