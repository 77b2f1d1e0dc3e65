// SPDX-License-Identifier: Apache-2.0
// Measures whole hands in moving sand with each way of `between`: whether an arm comes to rest, and how a tap feels.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "bench/report/curves.hpp"
#include "haptic_bridge/hand/arm_presets.hpp"
#include "tests/haptic_bridge/loop/logging_arm.hpp"
#include "tests/support/hand/hand_in_sand.hpp"

namespace bench {
namespace {

using sand::Between;

constexpr double kTapBegins = 2.5, kTapTakes = 0.1;  // [s]

/// Returns the height of a tapping tip over level sand [m]. The tip goes down by `depth` and back in 0.1 s.
double tapAt(double time, double depth) {
    constexpr double kLanding = 0.2;  // [s], down to the surface and up from it
    const double gone = time - kTapBegins;
    if (gone >= 0 && gone <= kTapTakes) {
        return -depth * std::pow(std::sin(std::numbers::pi * gone / kTapTakes), 2);
    }
    const double away = gone < 0 ? -gone : gone - kTapTakes;
    return depth * std::min(away / kLanding, 1.0);
}

struct Tap {
    double stiffness = 0;  // [N/m], K
    double peak = 0;       // [N]
    double delay = 0;      // [s], of the peak behind the deepest place
    double work = 0;       // [J], of the sand on the tip
};

/// Taps with a tip that no force moves.
Tap tap(const scene::Scene& scene, const haptic_bridge::ArmPhysics& arm) {
    const double radius = scene.toolRadius() / haptic_bridge::MappedDevice::scaleFor(arm, {}, scene);  // [m]
    const auto path = [radius](double time) -> haptic_bridge::ArmReading { return {{0, 0, tapAt(time, radius)}}; };
    std::vector<test::Push> pushes;
    test::HandInSand loop(scene, std::make_unique<test::LoggingArm>(arm, path, pushes));
    while (loop.time() < kTapBegins + kTapTakes + 0.5) {
        (void)loop.tick();
    }
    Tap result;
    result.stiffness = loop.limits().stiffness;
    for (std::size_t i = 1; i < pushes.size(); ++i) {
        const auto& [time, force] = pushes[i - 1];  // held until the next one
        result.work += dot(force, path(pushes[i].time).place - path(time).place);
        if (norm(force) > result.peak) {
            result.peak = norm(force);
            result.delay = time - (kTapBegins + kTapTakes / 2);
        }
    }
    return result;
}

}  // namespace

void betweenStability(const Settings&, Csv& csv) {
    constexpr double kWatched = 6, kLast = 0.5;  // [s]
    csv.note("A hand presses an arm one tool radius deep, and deeper by its dry friction over the grip. It digs a");
    csv.note("furrow, and holds still for 6 s.");
    csv.note("grip, grip_damping: of the hand [N/m], [N s/m]; K: stiffness that the guards allow [N/m]; rest: time");
    csv.note("until the arm is below 1 mm/s for good [s]; speed: the greatest one of the last 0.5 s [mm/s]; force: at");
    csv.note("the end [N].");
    csv.columns("between,arm,grip,grip_damping,K,rest,speed,force");
    for (const auto& [between, way] : valuesOf(Between{})) {
        const scene::Scene scene = test::writingSand(between);
        for (const std::string_view name : haptic_bridge::kArmPresets) {
            for (const haptic_bridge::Grip& grip : {test::kLightGrip, test::kUsualGrip}) {
                progress("{}, {}, {} N/m", way, name, grip.stiffness);
                test::DiggingHand hand(scene, *haptic_bridge::armPreset(name), grip);
                hand.runUntilItHolds();
                const std::vector<double> speeds = hand.run(kWatched);
                const double rest = test::restsAfter(speeds);
                const auto last = speeds.end() - std::lround(1000 * kLast);
                csv.row(way, name, grip.stiffness, grip.damping, hand.loop().limits().stiffness,
                        std::isfinite(rest) ? fmt::format("{:.3f}", rest) : "never",
                        1e3 * *std::max_element(last, speeds.end()), hand.sent());
            }
        }
    }
}

void tap(const Settings&, Csv& csv) {
    csv.note("A tip goes down by one tool radius and back in 0.1 s, whatever force it feels.");
    csv.note("K: stiffness that the guards allow [N/m]; peak: greatest force [N]; delay: of the peak behind the");
    csv.note("deepest place [ms]; work: that the sand does on the tip [mJ], positive if the hand gains.");
    csv.columns("between,arm,K,peak,delay,work");
    for (const auto& [between, way] : valuesOf(Between{})) {
        const scene::Scene scene = test::writingSand(between);
        for (const std::string_view name : haptic_bridge::kArmPresets) {
            progress("tap, {}, {}", way, name);
            const Tap felt = tap(scene, *haptic_bridge::armPreset(name));
            csv.row(way, name, felt.stiffness, felt.peak, 1e3 * felt.delay, 1e3 * felt.work);
        }
    }
}

}  // namespace bench
