// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "haptic_bridge/loop/guards/force_limits.hpp"
#include "sand/force/vec3.hpp"

namespace test {

/// Checks every push of an arm against the bounds of docs/forces.md. It shares no code with the guards.
///
/// wrong(force) checks the bounds that need no knowledge of the tick: finite, the device's force, growth. With Asked it
/// checks all bounds.
class PushCheck {
public:
    /// The part of a tick that a test knows, apart from its push.
    struct Asked {
        double time = 0;       // [s]
        bool fault = false;    // 0 must be pushed, and a ramp begins
        bool contact = false;  // the limited force is above 0
        bool edited = false;   // the first tick that feels a step with an edit
        bool engaged = true;   // the tool may touch the sand
        bool late = false;     // the device gave no reading, and the part `left` of the last push must be left
        double left = 0;
        bool damped = false;        // the observer takes some of the force
        double whole = 0;           // [N], norm of the limited force, at most the device's, in the hand's share
        double share = 1;           // of each force that clutch, operators and frozen sand leave
        sand::force::Vec3 place{};  // [m], of the hand
    };

    explicit PushCheck(const haptic_bridge::ForceLimits& limits)
        : maxForce_(limits.maxForce), slew_(limits.slew), stiffness_(limits.stiffness) {}

    /// Forgets all pushes. A ramp begins at `time` [s].
    void start(double time = 0) {
        last_ = {};
        from_ = time;
        contact_ = grows_ = false;
        crossesUntil_ = kNever;
    }
    /// Returns what is wrong with the next push; empty if it keeps all bounds.
    [[nodiscard]] std::string wrong(sand::force::Vec3 now) {
        const sand::force::Vec3 before = last_;
        last_ = now;
        const double size = sizeOf(now);
        if (!std::isfinite(size)) {
            return "it is not finite";
        }
        if (!(size <= above(maxForce_))) {  // false also for limits that are NaN
            return fmt::format("{} N are more than the device's {} N", size, maxForce_);
        }
        const double turned = fromShortened(before, now);
        if (!(turned <= above(1.5 * slew_))) {
            return fmt::format("it grows or turns by {} N, more than 1.5 times {} N", turned, slew_);
        }
        return {};
    }
    [[nodiscard]] std::string wrong(sand::force::Vec3 now, const Asked& asked) {
        const sand::force::Vec3 old = last_;
        const double before = sizeOf(old), size = sizeOf(now);
        if (asked.fault) {
            start(asked.time);
            return size == 0 ? std::string() : fmt::format("a fault pushes {} N", size);
        }
        if (std::string bad = wrong(now); !bad.empty()) {
            return bad;
        }
        if (asked.late) {
            const double off = sizeOf(now - asked.left * old);
            return off <= 1e-9 * before ? ""
                                        : fmt::format("{} of {} N must be left, not {} N", asked.left, before, size);
        }
        const double crossed = partCrossed(asked, before);
        const double along = before > 0 ? (old.x * now.x + old.y * now.y + old.z * now.z) / before : 0;
        const double least = leastAlong(asked, before, crossed);
        at_ = asked.time;
        place_ = asked.place;
        share_ = asked.share;
        if (!(along >= least - 1e-9 * before - 1e-12)) {
            return fmt::format("of {} N only {} N are left after an edit, less than {} N", before, along, least);
        }
        from_ = std::isfinite(from_) ? from_ : asked.time;  // a fault without a time
        const double ramp = std::min(std::max((asked.time - from_) / kRamp, 0.0), 1.0);
        if (!(size <= above(ramp * asked.share * maxForce_))) {
            return fmt::format("{} N are more than {} of the ramp and a share of {} allow", size, ramp, asked.share);
        }
        const double most = mostInContact(asked, ramp * asked.whole, before);
        return size <= above(std::max(most, grows_ ? before : 0))
                   ? std::string()
                   : fmt::format("{} N are more than the {} N of a contact or an edit", size, most);
    }

private:
    static constexpr double kRamp = 2, kContact = 0.2, kCrosses = 0.05;  // [s]
    static constexpr double kNever = -1e300;                             // [s]

    static double above(double most /* [N] */) { return most * (1 + 1e-9) + 1e-12; }
    static double sizeOf(sand::force::Vec3 v) { return std::hypot(v.x, v.y, v.z); }

    /// Returns the greatest force that a new contact or an edit allows [N]. `whole` is in its ramp; `before` is the
    /// size of the push before.
    double mostInContact(const Asked& asked, double whole, double before) {
        const bool begins = asked.contact && (!contact_ || asked.edited);
        contact_ = asked.contact;
        if (begins && whole > before + (1 + 1e-6) * slew_ + 1e-12) {
            grows_ = true;
            growsFrom_ = asked.time;
            base_ = before;
        }
        const double part = (asked.time - growsFrom_) / kContact;
        grows_ = grows_ && asked.contact && part < 1 - 1e-9;
        return grows_ ? base_ + std::max(part, 0.0) * std::max(whole - base_, 0.0) : maxForce_;
    }
    /// Returns which part of the way to the new force this tick may go: less than 1 within 50 ms after an edit.
    double partCrossed(const Asked& asked, double before) {
        if (asked.edited) {
            crossesUntil_ = at_ + kCrosses;
        }
        if (!asked.engaged || before == 0) {
            crossesUntil_ = kNever;
        }
        const double span = asked.time - at_, left = crossesUntil_ - asked.time;
        return span > 0 && left > 0 && left <= kCrosses ? span / (left + span) : 1;
    }
    /// Returns how much of the last push must be left along its direction [N].
    [[nodiscard]] double leastAlong(const Asked& asked, double before, double crossed) const {
        if (!(crossed < 1) || share_ == 0 || asked.damped) {
            return -maxForce_;
        }
        const double kept = std::max(before - stiffness_ * sizeOf(asked.place - place_), 0.0);
        return (1 - crossed) * std::min(asked.share / share_, 1.0) * kept - crossed * maxForce_;
    }
    /// Returns the distance of `now` from the nearest force that `before` may fall to.
    static double fromShortened(sand::force::Vec3 before, sand::force::Vec3 now) {
        const double square = before.x * before.x + before.y * before.y + before.z * before.z;
        const double part = square > 0 ? (before.x * now.x + before.y * now.y + before.z * now.z) / square : 0;
        const double kept = part < 0 ? 0 : part > 1 ? 1 : part;
        return std::hypot(now.x - kept * before.x, now.y - kept * before.y, now.z - kept * before.z);
    }

    double maxForce_, slew_, stiffness_;  // [N], [N/tick], [N/m]
    sand::force::Vec3 last_;
    double from_ = 0;  // [s], when the ramp began
    bool contact_ = false, grows_ = false;
    double growsFrom_ = 0, base_ = 0;  // [s], [N]
    double crossesUntil_ = kNever;     // [s]
    double at_ = 0, share_ = 1;        // [s], and share: of the last tick with a reading
    sand::force::Vec3 place_;          // [m], of the last tick with a reading
};

}  // namespace test
