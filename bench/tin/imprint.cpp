// SPDX-License-Identifier: Apache-2.0
// Measures a tool in a TIN without sweeps: an imprint far from the last one, and a step of dragging.
#include <array>
#include <cmath>
#include <random>

#include "bench/report/curves.hpp"
#include "bench/report/timing.hpp"
#include "sand/tin/tool/displacement.hpp"

namespace bench {
namespace {

using sand::tin::LatticePoint;
using sand::tin::VertexSand;

constexpr double kToolRadius = 16.8;  // [cell]; about 1000 cells are below a round tool and in the ring beside it
constexpr double kDepth = 2;          // [cell]
constexpr int kSamples = 16;          // samples of the hand per step
constexpr double kWay = 1.5;          // length of a step [cell]
constexpr int kEach = 10;             // imprints per run, and steps of its drag

/// Returns level sand with one vertex per cell, at a random place in the middle half of the cell.
VertexSand jittered(int side, std::mt19937& random) {
    sand::tin::Mesh mesh(side * sand::kProbePerCell, side * sand::kProbePerCell);
    std::vector<LatticePoint> places;
    for (std::int32_t y = 0; y < side; ++y) {
        for (std::int32_t x = 0; x < side; ++x) {
            const auto within = [&](std::int32_t cell) {
                return cell * sand::kProbePerCell + 64 + static_cast<std::int32_t>(random() % 128);
            };
            const std::int32_t east = within(x);
            places.push_back({east, within(y)});
        }
    }
    mesh.insert(places);
    return VertexSand(std::move(mesh));
}

sand::ProbePoint handAt(double x, double y, double z /* [cell] */) {
    const auto probe = [](double cells) { return static_cast<std::int32_t>(std::floor(cells * sand::kProbePerCell)); };
    return {probe(x), probe(y), probe(z)};
}

/// Returns the number of vertices from which the tool takes sand, or to which it gives sand, at the place `probe`.
int verticesNear(const VertexSand& layer, const sand::TurnedShape& shape, const sand::ProbePoint& probe) {
    int count = 0;
    for (const LatticePoint& place : layer.triangles().places) {
        const sand::Offset offset{std::int64_t{place.x} - probe.x, std::int64_t{place.y} - probe.y};
        count += shape.covers(offset) || shape.takes(offset) ? 1 : 0;
    }
    return count;
}

void measure(int side, sand::ToolKind kind, bool refines, const Settings& settings, Csv& csv) {
    std::mt19937 random(settings.seed);
    const auto radius = static_cast<std::int32_t>(kToolRadius * sand::kProbePerCell);
    const auto half = static_cast<std::int32_t>(radius * sand::usualWidth(kind));
    const sand::Tool tool{kind, radius, sand::isRound(kind) ? 0 : half};
    sand::tin::DetailRules rules;
    rules.spacing = refines ? sand::kProbePerCell : 0;
    std::vector<double> imprints, steps;
    int near = 0, vertices = 0;
    for (int run = 0; run < settings.runs; ++run) {
        VertexSand layer = jittered(side, random);
        vertices = layer.mesh().vertexCount();
        const auto somewhere = [&] {
            const auto cells = static_cast<double>(random() % 65536) / 65536;
            return 2 * kToolRadius + cells * (side - 4 * kToolRadius);
        };
        for (int i = 0; i < kEach; ++i) {
            const double x = somewhere();
            const sand::ProbePoint probe = handAt(x, somewhere(), kToolRadius - kDepth);
            // Only the first run counts, so that the number of runs does not matter.
            near = run == 0 ? verticesNear(layer, sand::TurnedShape(tool), probe) : near;
            sand::tin::Imprint imprint;
            imprints.push_back(secondsOf([&] {
                sand::tin::Displacement displacement(tool, rules);
                displacement.drag(layer, imprint, sand::Rim::closed, std::array{probe});
            }));
            sand::tin::Displacement(tool, rules).leave(layer, imprint);
            static_cast<void>(layer.takeChange());
        }
        sand::tin::Imprint imprint;
        sand::tin::Displacement displacement(tool, rules);
        double x = 2 * kToolRadius;
        for (int i = 0; i < kEach; ++i, x += kWay) {
            std::vector<sand::ProbePoint> path;
            for (int sample = 0; sample <= kSamples; ++sample) {
                path.push_back(handAt(x + kWay * sample / kSamples, side / 2.0, kToolRadius - kDepth));
            }
            steps.push_back(secondsOf([&] { displacement.drag(layer, imprint, sand::Rim::closed, path); }));
            static_cast<void>(layer.takeChange());
        }
    }
    for (const auto& [what, seconds] : {std::pair{"imprint", &imprints}, {"drag", &steps}}) {
        csv.row(what, base::nameOf(kind), refines ? "yes" : "no", side, vertices, near, 1e3 * quantile(*seconds, 0.5),
                1e3 * quantile(*seconds, 0.99), 1e3 * quantile(*seconds, 1));
    }
}

}  // namespace

void imprint(const Settings& settings, Csv& csv) {
    csv.note(
        fmt::format("a tool of radius {} cells, {} cells deep, in a TIN with one vertex per cell; no sweeps; CPU time",
                    kToolRadius, kDepth));
    csv.note("imprint: the tool at a new place, with the edges of its outline as constraints");
    csv.note(fmt::format("drag: a step of {} cells and {} samples, the imprint before taken out", kWay, kSamples));
    csv.note(
        "refined: whether the mesh is refined around the tool, to a nominal cell; near: vertices below and beside the "
        "tool");
    csv.columns("what,tool,refined,N,vertices,near,ms_median,ms_p99,ms_max");
    for (const int side : settings.sizes) {
        for (const sand::ToolKind kind : {sand::ToolKind::circle, sand::ToolKind::ellipse, sand::ToolKind::footprint}) {
            for (const bool refines : {false, true}) {
                if (side < 6 * kToolRadius) {
                    continue;
                }
                progress("N = {}, {}", side, base::nameOf(kind));
                measure(side, kind, refines, settings, csv);
            }
        }
    }
}

}  // namespace bench
