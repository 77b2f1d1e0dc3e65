// SPDX-License-Identifier: Apache-2.0
// Runs whole haptic servers under a virtual clock: hands that rest or stroke, operators that edit, walls whose sweeps
// cost time, and arms that lose readings.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "bench/report/curves.hpp"
#include "tests/haptic_bridge/loop/strong_arm.hpp"
#include "tests/haptic_bridge/loop/virtual_server.hpp"
#include "tests/support/hand/arm_on_sand.hpp"

namespace bench {
namespace {

using haptic_bridge::Guard;
using sand::force::Vec3;

constexpr double kWarms = 3, kWatched = 8;  // [s]
constexpr double kMostFall = 0.67;          // [N/tick], of an edit
constexpr double kWhole = 1 + 1e-9;         // with the rounding of a double
constexpr double kLeastMean = 0.9;          // of the mean force without lost readings

enum class Lost { none, oneIn250, bursts };
struct Trial {
    int cells = 0;       // radius of the tool
    double sweepMs = 0;  // cost of a sweep
    double speed = 0;    // [m/s], of the hand
    bool edits = false;
    Lost lost = Lost::none;
};

struct Felt {
    double most = 0, growth = 0;                 // [N], [N/tick]
    double byEdit = 0, byHand = 0, byFault = 0;  // [N/tick], largest falls
    double energy = 0;                           // [J], given to the hand
    double ticks = 0, mean = 0;                  // share of the ticks with force; [N]
    double slew = 0;                             // [N/tick]
};

scene::Scene sceneOf(const Trial& trial) {
    scene::Scene scene = test::levelSand({}, 512);
    scene.rules.tuning.tool.radius = trial.cells * sand::kProbePerCell;
    scene.rules.tuning.sweepsPerStep = trial.cells < 20 ? 18 : 72;  // of a settling time of 0.1 s
    return scene;
}

/// Returns the place of a hand that strokes to and fro one tool radius deep, and leaves the sand every four seconds.
Vec3 strokeAt(double time, double speed, double radius) {
    constexpr double kHalf = 0.02, kPeriod = 4, kOut = 0.4;  // [m], [s], [s]
    if (!(speed > 0)) {
        return {0, 0, -radius};
    }
    const double turn = std::fmod(speed * time, 4 * kHalf);  // [m], along the way
    const double along = turn < 2 * kHalf ? turn - kHalf : 3 * kHalf - turn;
    const double out = speed * std::max(kOut - std::abs(std::fmod(time, kPeriod) - kPeriod / 2), 0.0);
    return {along, 0, std::min(out - radius, radius)};
}

bool isLost(Lost lost, int tick) {
    constexpr int kEvery = 250, kSecond = 1000, kShort = 9, kLong = 30, kLongEvery = 6;
    switch (lost) {
        case Lost::none:
            return false;
        case Lost::oneIn250:
            return tick % kEvery == 0;
        case Lost::bursts:
            return tick % kSecond < (tick / kSecond % kLongEvery == kLongEvery - 1 ? kLong : kShort);
    }
    return false;
}

/// Gives the edit of the second `second`: another tool, another material, a reset or an undo.
void giveEdit(test::VirtualServer& server, const sand::Tuning& scenes, int second) {
    sand::Tuning tuning = scenes;
    constexpr int kKinds = 6;
    switch (second % kKinds) {
        case 0:
            tuning.tool.radius /= 3;
            break;
        case 2:
            tuning.threshold = tuning.startThreshold = tuning.threshold / 4;
            break;
        case 4:
            server.edit(sand::Edit::reset);
            return;
        case kKinds - 1:
            server.edit(sand::Edit::undo);
            return;
        default:  // the scene's own
            break;
    }
    server.edit(sand::Edit::tuned(tuning));
}

/// Returns by how much `now` is away from the nearest force that `before` may fall to [N].
double grownBy(Vec3 before, Vec3 now) {
    const double square = dot(before, before);
    const double kept = square > 0 ? std::clamp(dot(before, now) / square, 0.0, 1.0) : 0;
    return norm(now - kept * before);
}

Felt run(const Trial& trial) {
    const scene::Scene scene = sceneOf(trial);
    const haptic_bridge::ArmPhysics arm = test::strongArm();
    const double radius = scene.toolRadius() / haptic_bridge::MappedDevice::scaleFor(arm, {}, scene);  // [m]
    int ticks = 0;
    test::VirtualServer server(scene, arm, [&](double time) -> haptic_bridge::ArmReading {
        return {strokeAt(time, trial.speed, radius), true, false, !isLost(trial.lost, ++ticks)};
    });
    server.sweepNs = std::llround(1e6 * trial.sweepMs);
    server.link();
    server.run(kWarms);

    Felt felt;
    felt.slew = server.hand().guards().limits().slew;
    const auto& observer = server.hand().guards().passivity();
    const double before = observer.returned();
    const int count = static_cast<int>(1000 * kWatched);
    Vec3 last = server.pushed();
    for (int tick = 0; tick < count; ++tick) {
        if (trial.edits && tick % 1000 == 500) {
            giveEdit(server, scene.rules.tuning, tick / 1000);
        }
        server.tick();
        const Vec3 now = server.pushed();
        const std::uint32_t acted = server.last().guards;
        const double fall = norm(last) - norm(now);
        double& largest = (acted & (haptic_bridge::kFaults | bit(Guard::unread))) != 0 ? felt.byFault
                          : (acted & bit(Guard::edit)) != 0                            ? felt.byEdit
                                                                                       : felt.byHand;
        largest = std::max(largest, fall);
        felt.most = std::max(felt.most, norm(now));
        felt.growth = std::max(felt.growth, grownBy(last, now));
        felt.mean += norm(now) / count;
        felt.ticks += norm(now) > 0 ? 1.0 / count : 0;
        last = now;
    }
    felt.energy = observer.returned() - before;
    return felt;
}

std::vector<Trial> allTrials() {
    std::vector<Trial> trials;
    for (const int cells : {10, 40}) {
        for (const double sweepMs : {0.005, 0.02, 0.1, 0.5, 2.0}) {
            for (const double speed : {0.0, 0.03, 0.2}) {
                trials.push_back({cells, sweepMs, speed, true});
            }
            trials.push_back({cells, sweepMs, 0.03, false, Lost::oneIn250});
            trials.push_back({cells, sweepMs, 0.2, false, Lost::bursts});
        }
    }
    return trials;
}

constexpr const char* nameOf(Lost lost) {
    return lost == Lost::none ? "none" : lost == Lost::oneIn250 ? "1 in 250" : "bursts";
}
constexpr const char* inWords(bool held) { return held ? "held" : "NOT held"; }

/// Returns the mean force of `felt` over that of the same run without lost readings; 1 if that has none.
double keptOf(Trial trial, const Felt& felt) {
    trial.lost = Lost::none;
    const double without = run(trial).mean;
    return without > 0 ? felt.mean / without : 1;
}

}  // namespace

void forceLoop(const Settings& settings, Csv& csv) {
    csv.note(
        "A server, its guards and its sand under a virtual clock, for 8 s after the ramp of the start. The arm has a");
    csv.note(
        "greatest force of 8 N and a slew limit of 0.667 N/tick. It moves as told, whatever pushes it: it strokes");
    csv.note(
        "one tool radius deep, and leaves the sand every 4 s. Edits, one each second: a smaller tool, the scene's");
    csv.note("tool, slippery sand, the scene's sand, reset, undo.");
    csv.note("tool: its radius [cell]; sweep: cost of a sweep that the wall reports [ms]; speed: of the hand [m/s];");
    csv.note("lost: readings; `bursts`: 9 in a row each second, and 30 in every sixth second; largest: force [N];");
    csv.note(
        "growth: in a tick [N]; by_edit, by_fault, by_hand: largest fall in a tick [N], within 50 ms after an edit,");
    csv.note("in a tick with a fault or without a reading, and in all others; energy: given to the hand [mJ]; ticks:");
    csv.note(
        "share with force; mean: force [N]; kept: mean over that without lost readings. bars: whether growth stays");
    csv.note("within 1.5 slew limits, a fall by an edit within 0.67 N a tick, and kept at 0.9 with 1 in 250 lost.");
    csv.columns("tool,sweep,speed,edits,lost,largest,growth,by_edit,by_hand,by_fault,energy,ticks,mean,kept,bars");
    double growth = 0, fall = 0, kept = 1;  // the worst
    std::vector<Trial> trials = allTrials();
    trials.resize(std::min(trials.size(), static_cast<std::size_t>(settings.runs)));
    for (const Trial& trial : trials) {
        progress("{} cells, {} ms, {} m/s, {}", trial.cells, trial.sweepMs, trial.speed, nameOf(trial.lost));
        const Felt felt = run(trial);
        const double part = trial.lost == Lost::none ? 1 : keptOf(trial, felt);
        const double grown = felt.growth / (haptic_bridge::ForceGate::kMostSlews * felt.slew);
        const bool few = trial.lost == Lost::oneIn250 && part < kLeastMean;
        const char* const broken = grown > kWhole            ? "growth"
                                   : felt.byEdit > kMostFall ? "by_edit"
                                   : few                     ? "kept"
                                                             : "held";
        growth = std::max(growth, grown);
        fall = std::max(fall, felt.byEdit);
        kept = trial.lost == Lost::oneIn250 ? std::min(kept, part) : kept;
        csv.row(trial.cells, trial.sweepMs, trial.speed, trial.edits ? "each second" : "none", nameOf(trial.lost),
                felt.most, felt.growth, felt.byEdit, felt.byHand, felt.byFault, 1e3 * felt.energy, felt.ticks,
                felt.mean, part, broken);
    }
    progress("growth within the gate's 1.5 slew limits: {}, {:.3f} of them at most", inWords(growth <= kWhole), growth);
    progress("a fall by an edit of at most {} N a tick: {}, {:.3f} N", kMostFall, inWords(fall <= kMostFall), fall);
    progress("one reading in 250 lost, at least {} of the mean force: {}, {:.3f} at least", kLeastMean,
             inWords(kept >= kLeastMean), kept);
}

}  // namespace bench
