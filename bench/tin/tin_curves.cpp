// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <vector>

#include "bench/report/curves.hpp"
#include "bench/report/timing.hpp"
#include "sand/tin/flow/erosion.hpp"
#include "sand/tin/flow/settle.hpp"
#include "tests/support/sand/oracles.hpp"
#include "tests/support/sand/tin_piles.hpp"

namespace bench {
namespace {

using tin_piles::Kind;
using tin_piles::VertexSand;

constexpr std::int32_t kSteepest = 65536;  // [unit per cell], 45 degrees

struct Shape {
    const char* name;
    double radius, height;  // share of the field's side
};

void measurePile(Kind kind, int side, double degrees, const Shape& shape, const Settings& settings, Csv& csv) {
    progress("{}, {} x {}, turned by {}, {}", nameOf(kind), side, side, degrees, shape.name);
    const oracles::Cylinder cylinder(shape.radius * side, shape.height * side);
    const auto started = [&] {
        VertexSand layer = tin_piles::layerOf(kind, side, degrees, settings.seed);
        tin_piles::fill(layer, oracles::around(side / 2.0, side / 2.0, [&](double r) { return cylinder.start(r); }));
        return layer;
    };
    VertexSand layer = started();
    const sand::tin::Wide before = layer.volume();
    sand::tin::Settled settled;
    std::vector<double> seconds{secondsOf([&] { settled = sand::tin::settle(layer, kSteepest, kSteepest); })};
    for (const int runs = runsFor(seconds.front(), settings.runs); static_cast<int>(seconds.size()) < runs;) {
        VertexSand again = started();
        seconds.push_back(secondsOf([&] { sand::tin::settle(again, kSteepest, kSteepest); }));
    }
    const Spread spread = spreadOf(seconds);
    const double error = tin_piles::misplaced(
        layer, oracles::around(side / 2.0, side / 2.0, [&](double r) { return cylinder.rest(r); }));
    csv.row(nameOf(kind), shape.name, side, degrees, layer.mesh().vertexCount(), error, settled.iterations,
            settled.sweeps, settled.atRest ? 1 : 0, layer.volume() == before ? 1 : 0, seconds.size(), spread.median,
            spread.lowest, spread.highest);
}

}  // namespace

void tinPiles(const Settings& settings, Csv& csv) {
    csv.note(
        "error: volume between the pile at rest and the right one, over its volume; iterations of the projection,");
    csv.note("then sweeps, settled 0: 1,000,000 were not enough; seconds: of this thread, from the cylinder to rest;");
    csv.note("exact: whether the volume has stayed the same");
    csv.columns(
        "mesh,pile,N,degrees,vertices,error,iterations,sweeps,settled,exact,runs,seconds_median,seconds_min,seconds_"
        "max");
    for (const int side : settings.sizes) {
        for (const Shape& shape : {Shape{"low", 0.25, 0.15}, Shape{"tall", 0.15, 0.45}}) {
            for (const double degrees : {0.0, 9.0, 22.5, 45.0}) {
                measurePile(Kind::regular, side, degrees, shape, settings, csv);
                measurePile(Kind::jittered, side, degrees, shape, settings, csv);
            }
            measurePile(Kind::random, side, 0, shape, settings, csv);
        }
    }
}

void tinActive(const Settings& settings, Csv& csv) {
    csv.note(
        "100 sweeps after a cone of about 1000 vertices has been put on level sand, in another place in every run;");
    csv.note("first: the mesh's weights must be computed; again: they are known; mean over the vertices that moved");
    csv.columns("N,vertices,raised,moved,first_ms,again_ms,first_ns_per_vertex_sweep,again_ns_per_vertex_sweep");
    constexpr int kTimedSweeps = 100;
    for (const int side : settings.sizes) {
        VertexSand layer = tin_piles::layerOf(Kind::jittered, side, 0, settings.seed);
        sand::tin::Erosion erosion(layer, kSteepest, kSteepest);
        std::vector<sand::tin::Vertex> moved;
        erosion.sweep(layer, 1, nullptr, moved);
        for (int run = 0; run < settings.runs; ++run) {
            const double x = side * (0.2 + 0.6 * run / settings.runs);
            std::vector<sand::tin::Vertex> raised;
            for (sand::tin::Vertex v = 0; v < static_cast<sand::tin::Vertex>(layer.heights().size()); ++v) {
                const sand::tin::LatticePoint& at = layer.triangles().places[static_cast<std::size_t>(v)];
                const double away = std::hypot(at.x / 256.0 - x, at.y / 256.0 - side / 2.0);
                if (away < 18) {
                    raised.push_back(v);
                }
                layer.setHeight(v, away < 18 ? static_cast<std::int32_t>(1.5 * kSteepest * (18 - away)) : 0);
            }
            const auto milliseconds = [&] {
                moved.clear();
                return 1000 * secondsOf([&] {
                           erosion.wake(raised);
                           erosion.sweep(layer, kTimedSweeps, nullptr, moved);
                       });
            };
            const double first = milliseconds();
            const double perVertex = 1e6 * first / kTimedSweeps / static_cast<double>(moved.size());
            const double again = milliseconds();
            csv.row(side, layer.mesh().vertexCount(), raised.size(), moved.size(), first, again, perVertex,
                    1e6 * again / kTimedSweeps / static_cast<double>(moved.size()));
            for (const sand::tin::Vertex v : moved) {
                layer.setHeight(v, 0);
            }
            erosion.settle(layer, 1'000'000, moved);
        }
    }
}

}  // namespace bench
