// SPDX-License-Identifier: Apache-2.0
// Measures the work of a force without a potential along closed paths.
#include <array>
#include <cmath>
#include <numbers>

#include "bench/report/curves.hpp"
#include "bench/report/timing.hpp"
#include "sand/force/force_model.hpp"

namespace bench {
namespace {

using sand::force::Vec3;

constexpr double kTurnRadius = 0.01;  // [scene unit], the tool of Dorjgotov et al. 2007
constexpr int kTurnCells = 10;        // per radius
constexpr int kTurnTicks = 20000;     // per turn: twenty seconds

sand::force::SurfacePatch slopePatch(int side, double slope) {
    sand::HeightField field(side, side, kTurnRadius / kTurnCells);
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            field.setHeight(column, row,
                            static_cast<std::int32_t>(slope * (column + 0.5 - side / 2.0) * sand::kUnitsPerCell));
        }
    }
    const std::int32_t middle = side * sand::kProbePerCell / 2;
    return {field, {middle, middle, 0}, kTurnRadius};
}

struct Work {
    double net = 0, exchanged = 0;  // [N · scene unit]
};

/// Returns the work along a circle in the plane of the slope's steepest line and the vertical. Its depth is from
/// `shallow` to `shallow` + 1 [radius].
Work around(const sand::ForceConstants& constants, const sand::force::SurfacePatch& patch, int side, double shallow) {
    const double middle = kTurnRadius * side / kTurnCells / 2;
    const auto tool = sand::force::Contour::sphere(kTurnRadius);
    sand::force::ForceModel model(constants);
    Work work;
    Vec3 from, before;
    for (int tick = 0; tick <= kTurnTicks; ++tick) {
        const double turn = 2 * std::numbers::pi * tick / kTurnTicks;
        const double depth = kTurnRadius * (shallow + 0.5 - 0.5 * std::cos(turn));
        const Vec3 to{middle + kTurnRadius / 2 * std::sin(turn), middle, kTurnRadius - depth};
        const Vec3 now = model.at(patch, 1, tool, to, 1e-3 * tick).push;
        if (tick > 0) {
            const double part = dot(0.5 * (before + now), to - from);
            work.net += part;
            work.exchanged += std::abs(part);
        }
        from = to;
        before = now;
    }
    return work;
}

}  // namespace

void forceWork(const Settings& settings, Csv& csv) {
    csv.note(
        "a sphere moves once round an upright circle on the slope's steepest line, in twenty seconds. The circle is a "
        "radius across. The sand does not move, and there is no friction");
    csv.note(
        "shallow: least depth [radius]; net: work of the turn [N scene unit], positive if the hand "
        "gains; exchanged: sum of |work| along it; share: |net| over exchanged");
    csv.columns("law,N,slope,shallow,net,exchanged,share");
    for (const int side : settings.sizes) {
        for (const auto law : {sand::ForceLaw::repulse, sand::ForceLaw::controlPoints}) {
            const char* name = law == sand::ForceLaw::repulse ? "repulse" : "control points";
            progress("{}, N = {}", name, side);
            sand::ForceConstants constants;
            constants.law = law;
            constants.unitLength = kTurnRadius * side / kTurnCells;
            for (const double slope : {0.0, 0.1, 0.25, 0.5}) {
                const auto patch = slopePatch(side, slope);
                for (const double shallow : {0.0, 0.5, 1.0}) {
                    const Work work = around(constants, patch, side, shallow);
                    csv.row(name, side, slope, shallow, work.net, work.exchanged, std::abs(work.net) / work.exchanged);
                }
            }
        }
    }
}

}  // namespace bench
