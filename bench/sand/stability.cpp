// SPDX-License-Identifier: Apache-2.0
// Measures the stiffest springs on which an arm comes to rest, with and without the guards.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "bench/report/chosen_rows.hpp"
#include "bench/report/curves.hpp"
#include "haptic_bridge/loop/guards/guards.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/hand/arm_loop.hpp"
#include "tests/support/hand/arm_on_sand.hpp"

namespace bench {
namespace {

using haptic_bridge::ArmPhysics;
using haptic_bridge::ForceLimits;
using haptic_bridge::Guards;
using haptic_bridge::SimulatedArm;

/// Returns whether an arm comes to rest on a flat spring of `stiffness`, through the guards if `mode` is `on`.
///
/// The arm is pressed onto the spring with half of its greatest force and pushed at 0.1 m/s. It is at rest if it is
/// slower than 1 mm/s after 3 s. A heavy arm gets 6 ln(1000) times mass over damping, half as
/// long again as with half of its damping.
bool rests(const ArmPhysics& physics, double stiffness /* [N/m] */, Guards::Mode mode) {
    const haptic_bridge::LawAtRadius law{stiffness, 0, 0};
    ForceLimits limits = ForceLimits::of(physics, 1, law, 0);
    limits.fastestThing = std::numeric_limits<double>::infinity();  // the arm starts inside the spring
    const double soft = mode == Guards::Mode::on ? limits.lawStiffness : stiffness;
    Guards guards(limits, mode);
    SimulatedArm arm(physics);
    const double load = physics.maxForce / 2;
    const double seconds = std::max(3.0, 6 * physics.mass / physics.damping * std::log(1e3));
    constexpr long kWarm = 2001;  // [tick]
    // Behind the guards the contact begins at the surface, a tick before. In the deep it would begin with a ramp.
    const long touches = mode == Guards::Mode::on ? kWarm - 1 : kWarm;
    const long ticks = kWarm + std::lround(seconds * 1000);
    double fastest = 0;
    for (long tick = 0; tick < ticks; ++tick) {
        if (tick == kWarm - 1) {
            arm.start({0, 0, -2 * std::max(physics.resolution, 1e-5)}, {});
        } else if (tick == kWarm) {
            arm.start({0, 0, -load / soft}, {0, 0, -0.1});
            arm.load({0, 0, -load});
        }
        Guards::Reading reading;
        reading.time = static_cast<double>(tick) * 1e-3;
        reading.place = arm.read(reading.time).place;
        reading.engaged = tick >= touches;
        reading.felt = {{0, 0, std::max(0.0, -stiffness * reading.place.z)}, {0, 0, 1}, 0, stiffness};
        arm.push(guards.tick(reading).sent);
        fastest = tick >= ticks - 100 ? std::max(fastest, std::abs(arm.velocity().z)) : fastest;
    }
    return fastest < 1e-3;
}

/// Returns the greatest stiffness between `low` and `high` on which the arm comes to rest [N/m], by bisection.
double stiffest(const ArmPhysics& physics, Guards::Mode mode, double low, double high) {
    if (rests(physics, high, mode)) {
        return high;
    }
    for (int halving = 0; halving < 16; ++halving) {
        const double middle = std::sqrt(low * high);
        (rests(physics, middle, mode) ? low : high) = middle;
    }
    return low;
}

/// An arm of the curve guarded-sweep, with its name among the --rows.
struct SweptArm {
    std::string name;
    std::string_view arm;
    int delay;       // [tick]
    double damping;  // [N s/m]
};

/// Returns the arms with the names in `settings`, or all arms without a name. Throws InputError for an unknown
/// name.
std::vector<SweptArm> swept(const Settings& settings, const std::vector<double>& dampings) {
    std::vector<SweptArm> arms;
    for (const std::string_view arm : haptic_bridge::kArmPresets) {
        for (const int delay : {0, 1}) {
            for (const double damping : dampings) {
                arms.push_back({fmt::format("{}/{}/{:g}", arm, delay, damping), arm, delay, damping});
            }
        }
    }
    return chosenRows(std::move(arms), settings.rows);
}

}  // namespace

void stability(const Settings& settings, Csv& csv) {
    csv.note("K, the stiffest spring [N/m] on which an arm comes to rest: below 1 mm/s within 3 s, or within the");
    csv.note("time of a heavy arm's damping; pressed with half of its greatest force, pushed at 0.1 m/s. theory:");
    csv.note("b/(T/2 + t_d); textbook: the preset's mass alone, by growth; literal: with its encoder, friction and");
    csv.note("motor; guarded: the stiffness that the guards allow; bears: the stiffest law with which the arm came");
    csv.note("to rest, tried up to 1e6.");
    csv.columns("arm,delay,b,theory,textbook,literal,guarded,bears");
    const std::vector<double> dampings =
        settings.runs > 1 ? std::vector<double>{0.1, 0.2, 0.35, 0.5, 1, 2, 3.5, 5, 10} : std::vector<double>{0.5, 5};
    for (const std::string_view name : haptic_bridge::kArmPresets) {
        for (const int delay : {0, 1}) {
            for (const double damping : dampings) {
                progress("stability of {}, delay {}, {} N s/m", name, delay, damping);
                ArmPhysics arm = *haptic_bridge::armPreset(name);
                arm.damping = damping;
                arm.delayTicks = delay;
                const double theory = damping / (5e-4 + 1e-3 * delay);
                double low = theory / 10, high = theory * 10;
                for (int halving = 0; halving < 20; ++halving) {
                    const double middle = std::sqrt(low * high);
                    const auto spring = [middle](double x) { return -middle * x; };
                    (test::growth(test::textbookArm(damping, delay, arm.mass), spring) < 1 ? low : high) = middle;
                }
                const double literal = stiffest(arm, Guards::Mode::literal, theory / 100, 1e6);
                const ForceLimits limits = ForceLimits::of(arm, 1, {1e9, 0, 0}, 0);
                const double bears = stiffest(arm, Guards::Mode::on, limits.stiffness / 100, 1e6);
                csv.row(name, delay, damping, theory, low, literal, limits.stiffness, bears);
            }
        }
    }
}

void guardedSweep(const Settings& settings, Csv& csv) {
    const bool full = settings.runs > 1;
    const std::vector<double> dampings = full ? std::vector<double>{0.5, 1, 2, 3.5, 5} : std::vector<double>{0.5};
    const std::vector<SweptArm> arms = swept(settings, dampings);
    csv.note("The constants of Dorjgotov et al. 2007 on level sand.");
    csv.note("Depth 0 to 3 radii, speed 0 to 1 m/s, pressed or held by a hand.");
    csv.note("rest: share of the trials below 1 mm/s within 3 s, or within what a heavy arm's damping takes.");
    csv.note("force: the greatest force asked of the device [N].");
    csv.note("unlimited: share of the ticks in the sand in which only the lowered constants act.");
    csv.note("deviation: relative difference in these ticks between the force sent and the law with these constants.");
    csv.columns("arm,delay,b,hand,trials,rest,force,max_force,deviation,unlimited,literal_rest,literal_force");
    const scene::Scene scene = test::levelSand();
    const std::vector<double> depths = full ? std::vector<double>{0, 0.5, 1, 2, 3} : std::vector<double>{1};
    const std::vector<double> speeds = full ? std::vector<double>{0, 0.03, 0.1, 0.3, 1} : std::vector<double>{0.3};
    for (const auto& [name, arm, delay, damping] : arms) {
        for (const bool held : {false, true}) {
            progress("sweep of {}, delay {}, {} N s/m", arm, delay, damping);
            test::Trial trial{*haptic_bridge::armPreset(arm), 0, 0, held};
            trial.arm.damping = damping;
            trial.arm.delayTicks = delay;
            int trials = 0, rest = 0, literalRest = 0;
            double force = 0, literalForce = 0, deviation = 0, touching = 0, unlimited = 0;
            for (const double depth : depths) {
                for (const double speed : speeds) {
                    trial.depth = depth;
                    trial.speed = speed;
                    trial.mode = Guards::Mode::on;
                    const test::Outcome guarded = run(trial, scene);
                    trial.mode = Guards::Mode::literal;
                    const test::Outcome literal = run(trial, scene);
                    ++trials;
                    rest += guarded.settles() ? 1 : 0;
                    literalRest += literal.settles() ? 1 : 0;
                    force = std::max(force, guarded.mostForce);
                    literalForce = std::max(literalForce, literal.mostForce);
                    deviation = std::max(deviation, guarded.deviation);
                    touching += static_cast<double>(guarded.touching);
                    unlimited += static_cast<double>(guarded.unlimited);
                }
            }
            csv.row(arm, delay, damping, held ? "held" : "pressed", trials, static_cast<double>(rest) / trials, force,
                    trial.arm.maxForce, deviation, touching > 0 ? unlimited / touching : 1.0,
                    static_cast<double>(literalRest) / trials, literalForce);
        }
    }
}

}  // namespace bench
