// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/loop/haptic_tick.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/input_error.hpp"
#include "haptic_bridge/hand/arm_presets.hpp"
#include "host/clock.hpp"
#include "scene/model/scene.hpp"

namespace haptic_bridge {
namespace {

ForceLimits limitsFor(const scene::Scene& scene, const Device& device, const LawAtRadius& law) {
    const double friction = static_cast<double>(scene.rules.tuning.threshold) / sand::kUnitsPerCell;
    const double unit = sand::probeUnit(scene.terrain.cellSize());
    const StepTiming steps{scene.force.between, static_cast<double>(scene.rules.stepsPerSecond)};
    if (const ArmPhysics* arm = device.physics()) {
        return ForceLimits::of(*arm, device.scale(), law, friction, unit / device.scale(), steps);
    }
    const double side = std::min(scene.rules.columns, scene.rules.rows) * scene.terrain.cellSize();
    const double scale = side / kTouchField;
    ArmPhysics touch = touchPreset();
    touch.name = "a recording, felt as with a Touch";
    touch.resolution = 0;
    ForceLimits limits = ForceLimits::of(touch, scale, law, friction, unit / scale, steps);
    limits.fastestThing = std::numeric_limits<double>::infinity();  // a stroke list goes down within one tick
    return limits;
}

/// Returns the limits. If there are none, lets go first, because an arm holds its last force.
ForceLimits limitsOrLetGo(const scene::Scene& scene, Device& device, const LawAtRadius& law) {
    try {
        return limitsFor(scene, device, law);
    } catch (const base::InputError&) {
        device.sendForce({});
        throw;
    }
}

/// Returns the limits in words. They name the constant that the gain lowers, because a law is proportional to it.
std::vector<std::string> inWords(const sand::ForceConstants& constants, const ForceLimits& limits,
                                 const LawAtRadius& law) {
    return constants.law == sand::ForceLaw::repulse ? limits.inWords("k_s", constants.stiffness, law)
                                                    : limits.inWords("F_M", constants.maxForce, law);
}

}  // namespace

HapticTick::HapticTick(const scene::Scene& scene, std::unique_ptr<Device> device, HandSettings::Datum datum,
                       Guards::Mode mode)
    : HapticTick(scene, std::move(device), datum, mode, lawAtRadius(scene)) {}

HapticTick::HapticTick(const scene::Scene& scene, std::unique_ptr<Device> device, HandSettings::Datum datum,
                       Guards::Mode mode, const LawAtRadius& law)
    : constants_(scene.force),
      model_(scene.force),
      device_(std::move(device)),
      mapping_(scene, device_->physics() != nullptr ? HandSettings::Datum::level : datum),
      probeUnit_(sand::probeUnit(scene.terrain.cellSize())),
      guards_(limitsOrLetGo(scene, *device_, law), mode),
      armVelocity_(guards_.limits().arm.resolution),
      velocity_(guards_.limits().resolution * guards_.limits().scale),
      words_(inWords(scene.force, guards_.limits(), law)) {
    restart();
    setProbe(tick_.probe);
}

HapticTick::~HapticTick() { letGo(); }

void HapticTick::letGo() noexcept {
    try {
        push({});
    } catch (...) {  // a device that takes no force any more
    }
}

void HapticTick::restart() {
    model_ = sand::force::ForceModel(constants_);
    guards_.forget();
    account_.forget();
    armVelocity_.restart();
    velocity_.restart();
    edits_.reset();
    tick_.probe = mapping_.probe(Pose{}).value_or(sand::ProbePoint{});
}

void HapticTick::rest(double deviceTime) {
    if (const auto probe = mapping_.probe(device_->read(deviceTime))) {
        setProbe(*probe);
    }
    push({});
}

/// Every force that the device gets goes through here. It is 0, or the gate has passed it.
void HapticTick::push(sand::force::Vec3 force) { device_->sendForce(force); }

bool HapticTick::feelsEdit(const FeltSand& surface) {
    const bool edited = edits_ && *edits_ != surface.edits;
    edits_ = surface.edits;
    return edited;
}

void HapticTick::setProbe(const sand::ProbePoint& probe) {
    const std::uint64_t x = static_cast<std::uint32_t>(probe.x), y = static_cast<std::uint32_t>(probe.y);
    probe_.store(x << 32U | y, std::memory_order_relaxed);
}

sand::ProbePoint HapticTick::probe() const {
    const std::uint64_t both = probe_.load(std::memory_order_relaxed);
    return {static_cast<std::int32_t>(static_cast<std::uint32_t>(both >> 32U)),
            static_cast<std::int32_t>(static_cast<std::uint32_t>(both)), 0};
}

HandSample HapticTick::tick(double deviceTime, std::int64_t nowNs, const FeltSand& surface) {
    const Pose pose = device_->read(deviceTime);
    const bool silent = !device_->answers(), late = silent && guards_.mayBeLate(deviceTime);
    input_ = {.time = deviceTime,
              .pose = pose,
              .reading = device_->reading(),
              .nowNs = nowNs,
              .surfaceAgeNs = nowNs - surface.timeNs,
              .stepAgeNs = nowNs - surface.stepNs,
              .surfaceStep = surface.step,
              .surfaceProbe = surface.probe,
              .talus = surface.talus,
              .share = share_.load(std::memory_order_relaxed),
              .edited = !late && feelsEdit(surface),
              .silent = silent,
              .tripped = mayNotPush()};
    const bool present = input_.reading.present;
    const auto probe = mapping_.probe(pose);
    tick_.probe = probe.value_or(tick_.probe);
    setProbe(tick_.probe);
    const bool engaged = late ? tick_.engaged : pose.engaged && probe.has_value() && present;
    const HandSample sample{nowNs, tick_.probe, engaged, mapping_.heading(pose)};

    const std::int64_t begin = host::monotonicNs();
    fillTick(sample.engaged);
    followHand(late);
    const double perMetre = guards_.limits().scale;
    // The time is on the device's clock. A recording of ticks keeps that clock, so that a replay finds the same forces.
    Guards::Reading reading{.time = deviceTime,
                            .present = present,
                            .silent = silent,
                            .tripped = input_.tripped,
                            .engaged = sample.engaged,
                            .edited = input_.edited,
                            .surfaceAge = tick_.surfaceAge,
                            .stepAge = tick_.stepAge,
                            .share = input_.reading.second ? 0 : input_.share,  // the clutch
                            .talus = input_.talus,
                            .place = (1 / perMetre) * tick_.place,
                            .velocity = (1 / perMetre) * tick_.velocity,
                            .felt = {}};
    if (!probe) {
        reading.place.x = std::numeric_limits<double>::quiet_NaN();
    }
    if (sample.engaged && !late) {
        reading.felt = model_.at(surface.patch, surface.step, surface.tool, tick_.place, deviceTime, input_.edited);
    }
    const Guards::Forces forces = guards_.tick(reading);
    tick_.lawful = forces.lawful;
    tick_.sent = forces.sent;
    tick_.guards = forces.acted;
    count(surface, reading);
    if (guards_.mode() == Guards::Mode::on) {
        breaker_.take(deviceTime, forces.acted);
        tripped_.store(breaker_.tripped(), std::memory_order_relaxed);
    }
    if (sample.engaged) {
        forceCost_.add(host::monotonicNs() - begin);
    }
    push(forces.sent);
    return sample;
}

/// Counts the tick, which is complete.
void HapticTick::count(const FeltSand& surface, const Guards::Reading& reading) {
    const double made = static_cast<double>(input_.nowNs - surface.madeNs) * 1e-9, sent = norm(tick_.sent);
    const bool known = reading.present && std::isfinite(norm(reading.place));
    const auto outcome =
        account_.tick({.time = tick_.time,
                       .asked = known ? std::optional(askedForce(guards_, reading, tick_.lawful)) : std::nullopt,
                       .sent = sent,
                       .acted = tick_.guards,
                       .share = input_.share,
                       .clutch = input_.reading.second,
                       .stopped = stoppedBy({tick_.stepAge, made, surface.held}, guards_.limits().stepSeconds)});
    counts_.add(tick_.guards);
    ticks_.add(tick_.time, tick_.guards, sent > 0, outcome);
}

/// Fills in the part of the tick that follows from input_ and from the place of the hand.
void HapticTick::fillTick(bool engaged) {
    tick_.time = input_.time;
    tick_.armPlace = input_.reading.place;
    tick_.place = sand::force::placeOf(tick_.probe, probeUnit_);
    tick_.surfaceStep = input_.surfaceStep;
    tick_.surfaceAge = static_cast<double>(input_.surfaceAgeNs) * 1e-9;
    tick_.stepAge = static_cast<double>(input_.stepAgeNs) * 1e-9;
    tick_.share = input_.share;
    tick_.talus = input_.talus;
    tick_.edited = input_.edited;
    tick_.engaged = engaged;
}

/// Finds the velocities of the hand. While the device may only be `late`, they stay, because a place that is repeated
/// would count as a hand that rests. After a longer silence they begin again.
void HapticTick::followHand(bool late) {
    if (late) {
        return;
    }
    if (input_.silent) {
        armVelocity_.restart();
        velocity_.restart();
    }
    tick_.armVelocity = armVelocity_.add(input_.time, tick_.armPlace);
    tick_.velocity = velocity_.add(input_.time, tick_.place);
}

/// Returns whether the Breaker has tripped, unless an operator has switched the force on since.
bool HapticTick::mayNotPush() {
    if (switchedOn_.exchange(false, std::memory_order_relaxed)) {
        breaker_.reset();
    }
    return breaker_.tripped();
}

}  // namespace haptic_bridge
