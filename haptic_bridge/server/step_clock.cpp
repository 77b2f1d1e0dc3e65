// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/server/step_clock.hpp"

#include <algorithm>
#include <cmath>

namespace haptic_bridge {
namespace {

constexpr double kLockRange = 0.05;               // share of the nominal period
constexpr double kSmoothing = 0.05;               // share of a new frame interval in the mean, per frame
constexpr double kPhaseGain = 0.1;                // share of the phase error that is corrected per step
constexpr std::int64_t kLate = 250'000'000;       // [ns], lateness after which the clock starts again
constexpr std::int64_t kFramesOld = 500'000'000;  // [ns] without a frame, after which the clock runs free

}  // namespace

StepClock::StepClock(int stepsPerSecond) : period_(1'000'000'000 / stepsPerSecond) {}

void StepClock::start(std::int64_t now) {
    due_ = now + period_;
    locked_ = false;
    frame_ = 0;
}

void StepClock::frameShown(std::int64_t now, std::int64_t intervalNs) {
    const double interval = static_cast<double>(intervalNs);
    const double nominal = static_cast<double>(period_);
    // One slow frame does not change the wall's rate.
    const bool near = std::abs(interval - nominal) < nominal / 2;
    if (near) {
        frame_ = frame_ == 0 ? interval : frame_ + kSmoothing * (interval - frame_);
    }
    lastFrame_ = now;
    locked_ = near && std::abs(frame_ - nominal) <= kLockRange * nominal;
}

void StepClock::advance(std::int64_t now) {
    if (now - due_ > kLate) {
        start(now);
        return;
    }
    if (!locked_ || due_ - lastFrame_ > kFramesOld) {
        due_ += period_;
        return;
    }
    // Lateness of the step just due against the middle between two swaps, in (−frame/2, frame/2].
    double error = std::fmod(static_cast<double>(due_ - lastFrame_) - frame_ / 2, frame_);
    error -= error > frame_ / 2 ? frame_ : 0;
    error += error <= -frame_ / 2 ? frame_ : 0;
    const double nominal = static_cast<double>(period_);
    const double next =
        std::clamp(frame_ - kPhaseGain * error, (1 - 2 * kLockRange) * nominal, (1 + 2 * kLockRange) * nominal);
    due_ += static_cast<std::int64_t>(next);
}

}  // namespace haptic_bridge
