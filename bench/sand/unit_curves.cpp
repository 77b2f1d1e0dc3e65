// SPDX-License-Identifier: Apache-2.0
// Measures the errors that the numbers cause: height bits, hysteresis band, and the sources of one pile's error.
#include <cmath>

#include "bench/report/curves.hpp"
#include "bench/sand/piles.hpp"
#include "bench/sand/relaxations.hpp"

namespace bench {
namespace {

/// A pile in units of 2^-bits cells. Sweeps compute in units, so scaled heights with a scaled threshold are the same
/// sand in coarser or finer numbers.
class Scaled {
public:
    Scaled(const Pile& pile, int bits) : field(pile.start), rules(rulesFor(pile.start)), scale_(std::ldexp(1.0, bits)) {
        for (int y = 0; y < pile.side(); ++y) {
            for (int x = 0; x < pile.side(); ++x) {
                const double cells = static_cast<double>(pile.start.height(x, y)) / sand::kUnitsPerCell;
                field.setHeight(x, y, static_cast<std::int32_t>(std::floor(cells * scale_ + 0.5)));
            }
        }
        rules.tuning.threshold = rules.tuning.startThreshold = static_cast<std::int32_t>(scale_);
    }

    [[nodiscard]] std::vector<double> heights() const {
        std::vector<double> result;
        for (int y = 0; y < field.rows(); ++y) {
            for (int x = 0; x < field.columns(); ++x) {
                result.push_back(field.height(x, y) / scale_);
            }
        }
        return result;
    }

    sand::HeightField field;
    sand::Rules rules;

private:
    double scale_;
};

bool fits(const Pile& pile, int bits) { return std::ldexp(pile.shape.apex() * 2, bits) <= sand::kMaxHeight; }

/// Returns the largest slope through a face of the pile. The talus is 1.
double steepest(const std::vector<double>& heights, int side) {
    const auto at = [&](int x, int y) { return heights[static_cast<std::size_t>(y * side + x)]; };
    double slope = 0;
    for (int y = 1; y + 1 < side; ++y) {
        for (int x = 1; x + 1 < side; ++x) {
            const double a = at(x + 1, y) - at(x, y);
            const double b = (at(x, y + 1) - at(x, y - 1) + at(x + 1, y + 1) - at(x + 1, y - 1)) / 4;
            slope = std::max(slope, std::hypot(a, b));
        }
    }
    return slope;
}

oracles::Distance errorOf(const Pile& pile, const std::vector<double>& heights) {
    return oracles::distance(
        pile.side(), pile.rest, [&](std::size_t i) { return heights[i]; }, [](int, int) { return true; });
}

}  // namespace

void heightBits(const Settings& settings, Csv& csv) {
    csv.note("bits: a height unit is 2^-bits cells; a row is missing if the pile exceeds the range of 32 bits");
    csv.note("too_steep: largest slope through a face at rest over the talus, minus 1");
    csv.columns("pile,N,bits,sweeps,misplaced,largest,apex,too_steep");
    for (const int side : settings.sizes) {
        for (const Pile& pile : pilesOf(side)) {
            for (int bits = 8; bits <= 24 && fits(pile, bits); bits += 2) {
                progress("{} pile, N = {}, 2^-{} cells", pile.name, side, bits);
                Scaled sand(pile, bits);
                const std::int64_t sweepsDone = sweepToRest(sand.field, sand.rules);
                const std::vector<double> heights = sand.heights();
                const oracles::Distance error = errorOf(pile, heights);
                csv.row(pile.name, side, bits, sweepsDone, error.misplaced, error.largest, error.apex,
                        steepest(heights, side) - 1);
            }
        }
    }
}

void band(const Settings& settings, Csv& csv) {
    csv.note("band: share of the talus by which the start threshold exceeds it");
    csv.columns("pile,method,N,band,sweeps,misplaced,largest,apex");
    for (const int side : settings.sizes) {
        for (const Pile& pile : pilesOf(side)) {
            for (const Method& method : methods({"G", "G plain"})) {
                for (const double width : {0.0, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 1e-1}) {
                    progress("{} pile, N = {}, {}, band {}", pile.name, side, method.name, width);
                    const auto relaxation = method.start(pile.start, rulesFor(pile.start, 1, width));
                    relaxation->sweep(kMostSweeps);
                    const oracles::Distance error = errorOf(pile, relaxation->heights());
                    csv.row(pile.name, method.name, side, width, relaxation->sweepsDone(), error.misplaced,
                            error.largest, error.apex);
                }
            }
        }
    }
}

void budget(const Settings& settings, Csv& csv) {
    csv.note("grid: pile at rest in the finest units that fit, against the analytic pile");
    csv.note("bits: pile at rest in units of 2^-16 cells against the pile in the finest units");
    csv.note("band: pile at rest with the default band of 1e-3 against the pile without a band");
    csv.note("iteration: pile after a quarter, half or nine tenths of the sweeps to rest, against the pile at rest");
    csv.note("misplaced: sum of |difference| over the sum of the reference");
    csv.columns("pile,N,part,misplaced");
    for (const int side : settings.sizes) {
        for (const Pile& pile : pilesOf(side)) {
            progress("{} pile, N = {}", pile.name, side);
            int finest = sand::kHeightBits;
            while (finest < 22 && fits(pile, finest + 1)) {
                ++finest;
            }
            Scaled fine(pile, finest);
            sweepToRest(fine.field, fine.rules);
            sand::HeightField rest = pile.start;
            const std::int64_t toRest = sweepToRest(rest, rulesFor(rest));
            sand::HeightField banded = pile.start;
            sweepToRest(banded, rulesFor(banded, 1, 1e-3));
            const Method g = methods({"G"}).front();
            const std::vector<double> atRest = g.start(rest, rulesFor(rest))->heights();

            csv.row(pile.name, side, "grid", misplaced(fine.heights(), pile.rest));
            csv.row(pile.name, side, "bits", misplaced(atRest, fine.heights()));
            csv.row(pile.name, side, "band", misplaced(banded, rest));
            for (const int percent : {25, 50, 90}) {
                const auto stopped = g.start(pile.start, rulesFor(pile.start));
                stopped->sweep(static_cast<int>(toRest * percent / 100));
                csv.row(pile.name, side, fmt::format("iteration {} %", percent), misplaced(stopped->heights(), atRest));
            }
            csv.row(pile.name, side, "all of the default",
                    misplaced(g.start(banded, rulesFor(banded))->heights(), pile.rest));
        }
    }
}

}  // namespace bench
