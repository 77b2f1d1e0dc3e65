// SPDX-License-Identifier: Apache-2.0
// How far a pile is from the right one, as its fluxes can prove, and as it really is.
#include "sand/certificate.hpp"

#include <cmath>

#include "bench/curves.hpp"
#include "bench/piles.hpp"
#include "bench/relaxations.hpp"
#include "sand/dual_projection.hpp"
#include "sand/settle.hpp"

namespace bench {
namespace {

/// Sweeps of plain G or of N4, one cell after another, that remember what passed every face: the erosion forgets it.
/// For piles whose rim stays level.
class RecordedSweeps {
public:
    RecordedSweeps(const sand::HeightField& start, const sand::Rules& rules)
        : field(start), flux(start.columns(), start.rows()), now_(start.columns(), start.rows()), rules_(rules) {}

    void runToRest() {
        while (sweep()) {
        }
    }

    /// The heights that fluxes from elsewhere lead to.
    void apply(const sand::NetFlux& others) {
        for (int y = 0; y < field.rows(); ++y) {
            for (int x = 0; x < field.columns(); ++x) {
                field.setHeight(x, y, field.height(x, y) + static_cast<std::int32_t>(others.rise(x, y)));
            }
        }
        flux.add(others);
    }

    sand::HeightField field;
    sand::NetFlux flux;

private:
    [[nodiscard]] std::int32_t at(int x, int y) const {
        return field.height(std::clamp(x, 0, field.columns() - 1), std::clamp(y, 0, field.rows() - 1));
    }
    /// Through a face, of the difference across it and the sum of the four differences along it [unit].
    [[nodiscard]] std::int64_t through(std::int32_t across, std::int64_t along) const {
        if (rules_.scheme == sand::Scheme::n4) {
            const std::int32_t size = std::abs(across);
            const std::int32_t moved = size > rules_.threshold ? (size - rules_.threshold + 3) / 4 : 0;
            return across < 0 ? -moved : moved;
        }
        const double slope = std::hypot(across, 0.25 * static_cast<double>(along));
        return slope > rules_.threshold ? static_cast<std::int64_t>(0.2499 * (1 - rules_.threshold / slope) * across)
                                        : 0;
    }
    bool sweep() {
        bool moved = false;
        for (int y = 0; y < field.rows(); ++y) {
            for (int x = 0; x < field.columns(); ++x) {
                const auto rise = [&](int x0, int y0, int dx, int dy) {
                    return std::int64_t{at(x0 + dx, y0 + dy)} - at(x0 - dx, y0 - dy);
                };
                if (x + 1 < field.columns()) {
                    now_.east(y)[x] = through(at(x, y) - at(x + 1, y), rise(x, y, 0, 1) + rise(x + 1, y, 0, 1));
                    moved |= now_.east(y)[x] != 0;
                }
                if (y + 1 < field.rows()) {
                    now_.north(y)[x] = through(at(x, y) - at(x, y + 1), rise(x, y, 1, 0) + rise(x, y + 1, 1, 0));
                    moved |= now_.north(y)[x] != 0;
                }
            }
        }
        if (moved) {
            apply(now_);
        }
        return moved;
    }

    sand::NetFlux now_;
    sand::Rules rules_;
};

double squaredDistance(const sand::HeightField& a, const sand::HeightField& b) {
    double sum = 0;
    for (int y = 0; y < a.rows(); ++y) {
        for (int x = 0; x < a.columns(); ++x) {
            const double difference = a.height(x, y) - b.height(x, y);
            sum += difference * difference;
        }
    }
    return sum;
}

/// The start projected onto the fields without a quad steeper than `steepest`.
sand::HeightField projected(const sand::HeightField& start, sand::Rules rules, double steepest) {
    rules.threshold = rules.startThreshold = static_cast<std::int32_t>(std::lround(steepest));
    sand::DualProjection projection(start, rules);
    projection.run();
    sand::NetFlux flux(start.columns(), start.rows());
    const sand::Rect& box = projection.box();
    for (int y = box.y0; y < box.y1; ++y) {
        for (int x = box.x0; x < box.x1; ++x) {
            flux.east(y)[x] = projection.eastFlux(x, y);
            flux.north(y)[x] = projection.northFlux(x, y);
        }
    }
    RecordedSweeps result(start, rules);
    result.apply(flux);
    return result.field;
}

}  // namespace

void certificate(const Settings& settings, Csv& csv) {
    csv.note("bound: the certificate's bound of the squared distance to the projection of the start, over the squared");
    csv.note("  distance that was moved; truth: the squared distance itself, by a projection to a gap of 1e-5");
    csv.note("gap: the bound with the talus for the steepest slope; bound and truth are");
    csv.note("  for the projection onto the fields without a quad steeper than the steepest at rest");
    csv.columns("pile,method,N,bound,gap,truth,steepest_over_talus");
    for (const int side : settings.sizes) {
        for (const Pile& pile : {lowPile(side), tallPile(side)}) {
            for (const std::string method : {"G plain", "N4", "settle"}) {
                progress("{} pile, N = {}, {}", pile.name, side, method);
                sand::Rules rules = rulesFor(pile.start);
                rules.scheme = method == "N4" ? sand::Scheme::n4 : sand::Scheme::plainIsotropic;
                RecordedSweeps sweeps(pile.start, rules);
                if (method == "settle") {
                    sand::NetFlux flux(side, side);
                    sand::HeightField settled = pile.start;
                    sand::settle(settled, rules, &flux);
                    sweeps.apply(flux);  // settle tells what its projection moved; its last sweeps are made here
                }
                sweeps.runToRest();
                const sand::Certificate proof = sand::certify(pile.start, sweeps.field, sweeps.flux, rules);
                const double truth =
                    squaredDistance(projected(pile.start, rules, proof.steepest), sweeps.field) / proof.squaredMoved;
                csv.row(pile.name, method, side, proof.relative(), proof.relativeGap(), truth,
                        proof.steepest / rules.threshold);
            }
        }
    }
}

}  // namespace bench
