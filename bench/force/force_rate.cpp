// SPDX-License-Identifier: Apache-2.0
// Measures the error of the force between two surfaces of the sand, by the rate of surfaces, and the time of a tick.
#include <array>
#include <cmath>
#include <numbers>

#include "bench/report/curves.hpp"
#include "bench/report/timing.hpp"
#include "sand/force/force_model.hpp"
#include "sand/force/law.hpp"
#include "sand/replica.hpp"
#include "scene/model/scene.hpp"

namespace bench {
namespace {

using sand::force::Vec3;

constexpr double kRadius = 0.01;  // [scene unit], the tool of Dorjgotov et al. 2007
constexpr int kCells = 10;        // per radius
constexpr int kTicks = 3000;      // at a thousand per second
constexpr int kSettled = 200;     // [tick]; the errors of earlier ticks come from the start and do not count
constexpr std::array kRates{15, 30, 60, 125, 250, 500, 1000};  // [1/s]

struct ForceMethod {
    const char* name;
    sand::Between between;
    double recovery;  // [s]
};
constexpr std::array kMethods{ForceMethod{"eq. 9", sand::Between::interpolate, 0},
                              ForceMethod{"hold", sand::Between::hold, 0},
                              ForceMethod{"local", sand::Between::local, sand::ForceConstants{}.recoveryTime},
                              ForceMethod{"local at once", sand::Between::local, 0}};

/// Returns the place of the hand at `time`. It writes a bent eight, and presses and lifts meanwhile: its depth is from
/// a third of a radius to one radius. It moves by up to half a radius in a sixtieth of a second.
Vec3 handAt(double time /* [s] */, int side) {
    const double turn = 2 * std::numbers::pi * time / 3, middle = kRadius * side / kCells / 2;
    const double depth = kRadius * (0.65 - 0.35 * std::cos(5 * turn));
    return {middle + 7 * kRadius * std::sin(turn), middle + 5 * kRadius * std::sin(2 * turn), kRadius - depth};
}

sand::ProbePoint probeAt(Vec3 place) {
    const Vec3 cells = kCells / kRadius * place;
    return sand::probePoint(cells.x, cells.y, cells.z);
}

scene::Scene sceneOf(int side) {
    scene::Scene scene;
    scene.terrain = sand::HeightField(side, side, kRadius / kCells);
    scene.rules.columns = scene.rules.rows = side;
    scene.rules.tuning.threshold = 44204;  // 34 degrees
    scene.rules.tuning.startThreshold = 44248;
    // Sand rests after a tenth of a second, as with sixty steps of 40 sweeps per second.
    scene.rules.tuning.sweepsPerStep = 3;
    scene.rules.stepsPerSecond = 1000;
    scene.rules.tuning.tool.radius = kCells * sand::kProbePerCell;
    return scene;
}

/// A force model that gets the sand at one rate, with its errors.
struct Follower {
    Follower(sand::ForceConstants constants, const ForceMethod& method, int rate)
        : name(method.name), every(1000 / rate), model([&] {
              constants.between = method.between;
              constants.recoveryTime = method.recovery;
              return constants;
          }()) {}

    const char* name;
    int every;  // [tick]
    sand::force::ForceModel model;
    sand::force::SurfacePatch patch;
    std::vector<double> seconds;  // of each tick
    double square = 0, most = 0, jump = 0;
    Vec3 last;

    void tick(int tick, const sand::force::SurfacePatch& now, const sand::force::Contour& tool, Vec3 place,
              Vec3 truth) {
        if (tick % every == 0) {
            patch = now;
        }
        const auto step = static_cast<std::uint64_t>(tick / every);
        Vec3 push;
        seconds.push_back(secondsOf([&] { push = model.at(patch, step, tool, place, 1e-3 * tick).push; }));
        if (tick >= kSettled) {
            const double error = norm(push - truth);
            square += error * error;
            most = std::max(most, error);
            jump = std::max(jump, norm(push - last));
        }
        last = push;
    }
};

/// A drag through the sand: the exact force at every tick, and all followers on the same sand.
struct Drag {
    std::vector<Follower> followers;
    double square = 0, jump = 0;       // sum of squares [N²] and largest change per tick [N] of the exact force
    std::vector<double> patchSeconds;  // of each copy of the sand

    Drag(const sand::ForceConstants& constants, int side) {
        for (const ForceMethod& method : kMethods) {
            for (const int rate : kRates) {
                followers.emplace_back(constants, method, rate);
            }
        }
        run(constants, side);
    }

private:
    void run(const sand::ForceConstants& constants, int side) {
        sand::Replica replica(sceneOf(side));
        const sand::HeightField& field = std::get<sand::GridData>(replica.surface().data()).field;
        const auto tool = sand::force::Contour::sphere(kRadius);
        sand::force::SurfacePatch patch;
        Vec3 last;
        for (int tick = 0; tick < kTicks; ++tick) {
            const Vec3 place = handAt(1e-3 * tick, side);
            replica.apply({1, replica.stepNumber() + 1, true, {probeAt(place)}});
            patchSeconds.push_back(
                secondsOf([&] { patch = sand::force::SurfacePatch(field, replica.probe(), kRadius); }));
            const Vec3 truth = respond(constants, patch, tool, place).push;
            for (Follower& follower : followers) {
                follower.tick(tick, patch, tool, place, truth);
            }
            if (tick >= kSettled) {
                square += dot(truth, truth);
                jump = std::max(jump, norm(truth - last));
            }
            last = truth;
        }
    }
};

void measure(const char* law, const sand::ForceConstants& constants, int side, int runs, Csv& csv) {
    progress("{} on {} x {} cells, {} runs", law, side, side, runs);
    std::vector<Drag> drags;
    drags.reserve(static_cast<std::size_t>(runs));
    for (int run = 0; run < runs; ++run) {
        drags.emplace_back(constants, side);
    }
    const double size = std::sqrt(drags[0].square / (kTicks - kSettled));
    for (std::size_t i = 0; i < drags[0].followers.size(); ++i) {
        const Follower& first = drags[0].followers[i];
        std::vector<double> micro, slowest;
        for (const Drag& drag : drags) {
            double sum = 0;
            for (const double seconds : drag.followers[i].seconds) {
                sum += seconds;
            }
            micro.push_back(1e6 * (sum / kTicks + quantile(drag.patchSeconds, 0.5) / first.every));
            slowest.push_back(1e6 * quantile(drag.followers[i].seconds, 0.99));
        }
        const double error = std::sqrt(first.square / (kTicks - kSettled));
        csv.row(law, side, first.name, 1000.0 / first.every, error, error / size, first.most, first.jump, drags[0].jump,
                runs, spreadOf(micro).median, spreadOf(micro).lowest, spreadOf(micro).highest,
                spreadOf(slowest).median);
    }
}

}  // namespace

void forceRate(const Settings& settings, Csv& csv) {
    csv.note(
        fmt::format("a sphere of {} cells writes an eight for {} s, a third to one radius deep, in sand that steps "
                    "a thousand times a second",
                    kCells, kTicks / 1000));
    csv.note(
        "truth: the law at every tick on the sand of that tick; rate: surfaces that a model gets per second [1/s]");
    csv.note(
        "rms, most: |push - truth| [N]; share: rms over the rms of truth; jump: most change of push in a tick [N]");
    csv.note(
        "us: CPU time of one thread per tick with the copy of the sand; p99: 99th percentile of a tick without the "
        "copy");
    csv.columns("law,N,method,rate,rms,share,most,jump,truth_jump,runs,us_median,us_min,us_max,us_p99");
    for (const int side : settings.sizes) {
        sand::ForceConstants constants;
        measure("repulse", constants, side, settings.runs, csv);
        constants.law = sand::ForceLaw::controlPoints;
        constants.unitLength = kRadius * side / kCells;
        measure("control points", constants, side, settings.runs, csv);
    }
}

}  // namespace bench
