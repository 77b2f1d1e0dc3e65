// SPDX-License-Identifier: Apache-2.0
// Measures the piles at rest: their error, their number of sweeps, and their radius by direction.
#include <map>

#include "bench/report/curves.hpp"
#include "bench/sand/piles.hpp"
#include "bench/sand/relaxations.hpp"

namespace bench {
namespace {

/// Returns the pile at rest. Floats may creep without end, so they stop after half as many sweeps as the field has
/// cells. Their piles have then long had their final shape.
std::unique_ptr<Relaxation> relaxed(const Method& method, const Pile& pile) {
    std::unique_ptr<Relaxation> relaxation = method.start(pile.start, rulesFor(pile.start));
    relaxation->sweep(method.integers ? kMostSweeps : pile.side() * pile.side() / 2);
    return relaxation;
}

/// Returns the methods for a pile of this side.
std::vector<Method> methodsOn(int side) { return side > kLargestSlow ? methods({"G", "settle"}) : allMethods(); }

sand::HeightField fieldFrom(const std::vector<double>& heights, int side) {
    sand::HeightField field(side, side, 1.0);
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const double height = heights[static_cast<std::size_t>(y * side + x)];
            field.setHeight(x, y, static_cast<std::int32_t>(std::floor(height * sand::kUnitsPerCell + 0.5)));
        }
    }
    return field;
}

}  // namespace

void errorAtRest(const Settings& settings, Csv& csv) {
    csv.note("misplaced: sum of |height - analytic mean over the cell| over the sum of the analytic means");
    csv.note("largest, apex: L-infinity error and error of the highest point [cell of this N]");
    csv.note("order: order of `misplaced` from the size before: log of the errors' ratio over log of the sizes' ratio");
    csv.note("sweeps: number until the sand is at rest; floats: until no sweep moves 1e-6 cells, at most N x N / 2");
    csv.note(fmt::format("beyond N = {} only G and settle; no tall pile beyond N = {}", kLargestSlow, kLargestTall));
    csv.columns("pile,method,integers,N,sweeps,at_rest,misplaced,largest,apex,order");
    struct Before {
        int side = 0;
        double error = 0;
    };
    std::map<std::string, Before> before;
    for (const int side : settings.sizes) {
        for (const Pile& pile : pilesOf(side)) {
            for (const Method& method : methodsOn(side)) {
                progress("{} pile, N = {}, {} to rest", pile.name, side, method.name);
                const std::unique_ptr<Relaxation> relaxation = relaxed(method, pile);
                const std::vector<double> heights = relaxation->heights();
                const auto error = oracles::distance(
                    side, pile.rest, [&](std::size_t i) { return heights[i]; }, [](int, int) { return true; });
                Before& last = before[pile.name + method.name];
                csv.row(pile.name, method.name, method.integers ? 1 : 0, side, relaxation->sweepsDone(),
                        relaxation->atRest() ? 1 : 0, error.misplaced, error.largest, error.apex,
                        observedOrder(last.error, last.side, error.misplaced, side));
                last = {side, error.misplaced};
            }
        }
    }
}

void sweeps(const Settings& settings, Csv& csv) {
    csv.note(
        "sweeps: number until the sand is at rest; band: share of the talus by which the start threshold exceeds it");
    csv.note("exponent: exponent of the sweeps in N, from the size before");
    csv.columns("pile,method,band,N,sweeps,exponent");
    struct Before {
        int side = 0;
        double sweeps = 0;
    };
    std::map<std::string, Before> before;
    for (const int side : settings.sizes) {
        for (const Pile& pile : pilesOf(side)) {
            for (const Method& method : methods({"G", "G plain", "N4"})) {
                for (const double bandWidth : {0.0, 1e-3}) {
                    progress("{} pile, N = {}, {}, band {}", pile.name, side, method.name, bandWidth);
                    const auto relaxation = method.start(pile.start, rulesFor(pile.start, 1, bandWidth));
                    relaxation->sweep(kMostSweeps);
                    const auto count = static_cast<double>(relaxation->sweepsDone());
                    Before& last = before[fmt::format("{}{}{}", pile.name, method.name, bandWidth)];
                    csv.row(pile.name, method.name, bandWidth, side, relaxation->sweepsDone(),
                            -observedOrder(last.sweeps, last.side, count, side));
                    last = {side, count};
                }
            }
        }
    }
}

void anisotropy(const Settings& settings, Csv& csv) {
    csv.note("radius_error: radius at half the pile's height in this direction over the analytic one, minus 1");
    csv.columns("pile,method,N,degrees,radius_error");
    for (const int side : settings.sizes) {
        for (const Pile& pile : pilesOf(side)) {
            for (const Method& method : methods(
                     {"G", "G plain", "N4", "float32 N4 in place", "float32 N8 Jacobi", "float32 N8 sqrt2 Jacobi"})) {
                progress("{} pile, N = {}, {}", pile.name, side, method.name);
                const sand::HeightField field = fieldFrom(relaxed(method, pile)->heights(), side);
                const double level = pile.shape.apex() / 2;
                for (int degrees = 0; degrees < 360; degrees += 3) {
                    const double radius = oracles::radiusAt(field, pile.centre(), pile.centre(), degrees, level);
                    csv.row(pile.name, method.name, side, degrees, radius / pile.shape.radiusAt(level) - 1);
                }
            }
        }
    }
}

void decay(const Settings& settings, Csv& csv) {
    csv.note("moved: volume that changed cell per sweep, over the pile's volume; mean since the sample before");
    csv.note("to_rest: sum of |height - height at this method's own rest| over the volume");
    csv.columns("pile,method,N,sweeps,moved,to_rest");
    for (const int side : settings.sizes) {
        for (const Pile& pile : pilesOf(side)) {
            for (const Method& method : methods({"G", "G plain", "N4", "float32 N4 in place"})) {
                progress("{} pile, N = {}, {}", pile.name, side, method.name);
                const std::vector<double> rest = relaxed(method, pile)->heights();
                std::vector<double> last = method.start(pile.start, rulesFor(pile.start))->heights();
                auto relaxation = method.start(pile.start, rulesFor(pile.start));
                std::int64_t done = 0;
                for (double wanted = 1; wanted <= side * side && !relaxation->atRest(); wanted *= 1.26) {
                    const auto sweepsWanted = static_cast<int>(wanted);
                    if (sweepsWanted <= done) {
                        continue;
                    }
                    relaxation->sweep(sweepsWanted - static_cast<int>(done));
                    const std::vector<double> now = relaxation->heights();
                    // Sand that moves is missing in one cell and surplus in another, so the moved volume is half of the
                    // sum.
                    const double moved = misplaced(now, last) / 2 / static_cast<double>(sweepsWanted - done);
                    csv.row(pile.name, method.name, side, sweepsWanted, moved, misplaced(now, rest));
                    last = now;
                    done = sweepsWanted;
                }
            }
        }
    }
}

}  // namespace bench
