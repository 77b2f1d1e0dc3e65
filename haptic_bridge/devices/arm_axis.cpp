// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/devices/arm_axis.hpp"

#include <cmath>

namespace haptic_bridge {
namespace {

/// Solution of m y'' + c y' + k y = f from (y, v) at time t.
struct Motion {
    double mass, damping, stiffness, force;

    struct State {
        double place, velocity;
    };

    [[nodiscard]] State at(State start, double t) const { return stiffness > 0 ? sprung(start, t) : free(start, t); }

private:
    [[nodiscard]] State free(State start, double t) const {
        if (!(damping > 0)) {
            const double a = force / mass;
            return {start.place + (start.velocity + a * t / 2) * t, start.velocity + a * t};
        }
        const double rate = damping / mass, last = force / damping;
        const double gone = -std::expm1(-rate * t);  // 1 − e^(−rate t)
        return {start.place + last * t + (start.velocity - last) * gone / rate,
                start.velocity + (last - start.velocity) * gone};
    }
    [[nodiscard]] State sprung(State start, double t) const {
        const double a = damping / (2 * mass), w2 = stiffness / mass - a * a;
        const double rest = force / stiffness, y = start.place - rest, v = start.velocity;
        // c = e^(−at) cos wt and s = e^(−at) sin(wt)/w, or the hyperbolic functions in their place, which must not
        // overflow.
        double c = 0, s = 0;
        if (w2 > 0) {
            const double w = std::sqrt(w2), decay = std::exp(-a * t);
            c = decay * std::cos(w * t);
            s = decay * std::sin(w * t) / w;
        } else if (w2 < 0) {
            const double w = std::sqrt(-w2), slow = std::exp((w - a) * t), fast = std::exp((-w - a) * t);
            c = (slow + fast) / 2;
            s = (slow - fast) / (2 * w);
        } else {
            c = std::exp(-a * t);
            s = c * t;
        }
        return {rest + y * c + (v + a * y) * s, v * c - (stiffness / mass * y + a * v) * s};
    }
};

/// Returns the first time in (0, most] at which the arm itself comes to a stop; `most` if it does not stop. The arm
/// moves by `drift` faster than it seems to move when seen from its target.
double firstStop(const Motion& motion, Motion::State start, double drift, double most) {
    const double sign = start.velocity + drift > 0 ? 1 : -1;
    const auto goesOn = [&](double t) { return sign * (motion.at(start, t).velocity + drift) > 0; };
    // A tick is a small part of any arm's period. Within a slice of it the velocity therefore crosses zero at most
    // once.
    constexpr int kSlices = 4, kHalvings = 50;
    double before = 0;
    for (int slice = 1; slice <= kSlices; ++slice) {
        double after = most * slice / kSlices;
        if (goesOn(after)) {
            before = after;
            continue;
        }
        for (int halving = 0; halving < kHalvings; ++halving) {
            const double middle = (before + after) / 2;
            (goesOn(middle) ? before : after) = middle;
        }
        return after;
    }
    return most;
}

}  // namespace

void ArmAxis::advance(const Body& body, double force, Target target, double time) {
    constexpr int kMostStops = 16;  // in one call; an arm that stops more often is at rest
    for (int stops = 0; time > 0 && stops < kMostStops; ++stops) {
        // Force on an arm at rest, and its growth per second while the target moves on.
        const double pull = force + body.grip.damping * target.velocity - body.grip.stiffness * (place - target.place);
        const double growth = body.grip.stiffness * target.velocity;
        const bool moves = velocity != 0;
        double direction = (moves ? velocity : pull) > 0 ? 1 : -1;
        if (!moves && std::abs(pull) <= body.friction) {
            direction = growth > 0 ? 1 : -1;
            const double held = growth != 0 ? (body.friction - direction * pull) / std::abs(growth) : time;
            if (held >= time) {
                return;
            }
            target.place += target.velocity * held;
            time -= held;
        }
        const double y = place - target.place;
        // Seen from the target, which moves at constant speed, the force is constant.
        const Motion motion{body.mass, body.damping + body.grip.damping, body.grip.stiffness,
                            force - direction * body.friction - body.damping * target.velocity};
        const Motion::State start{y, velocity - target.velocity};
        const bool mayStop = body.friction > 0 && moves;
        const double span = mayStop ? firstStop(motion, start, target.velocity, time) : time;
        const Motion::State end = motion.at(start, span);
        target.place += target.velocity * span;
        place = target.place + end.place;
        velocity = span < time ? 0 : end.velocity + target.velocity;
        time -= span;
    }
}

}  // namespace haptic_bridge
