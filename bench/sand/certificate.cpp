// SPDX-License-Identifier: Apache-2.0
// Measures the distance of a pile from the right one: the bound that its fluxes prove, and the true value.
#include "sand/grid/certificate.hpp"

#include "bench/report/curves.hpp"
#include "bench/sand/integer_n4.hpp"
#include "bench/sand/piles.hpp"
#include "bench/sand/relaxations.hpp"
#include "sand/grid/dual_projection.hpp"
#include "sand/grid/erosion.hpp"
#include "sand/grid/settle.hpp"

namespace bench {
namespace {

/// The heights after a relaxation, and the net flux across every face.
struct Relaxed {
    sand::HeightField field;
    sand::grid::NetFlux flux;
};

Relaxed swept(const sand::HeightField& start, const sand::Rules& rules, sand::Scheme scheme) {
    Relaxed result{start, {start.columns(), start.rows()}};
    sand::Rules own = rules;
    own.scheme = scheme;
    sand::grid::Erosion erosion(start, own);
    while (!erosion.settled()) {
        erosion.sweep(result.field, 1);
        erosion.addFluxes(result.flux);
    }
    return result;
}

Relaxed byFourNeighbours(const sand::HeightField& start, const sand::Rules& rules) {
    sand::grid::NetFlux flux(start.columns(), start.rows());
    IntegerN4 n4(start, rules);
    while (!n4.atRest()) {
        n4.sweep(1);
        n4.addFluxes(flux);
    }
    return {n4.field(), flux};
}

Relaxed bySettle(const sand::HeightField& start, const sand::Rules& rules) {
    Relaxed result{start, {start.columns(), start.rows()}};
    sand::grid::settle(result.field, rules, &result.flux);
    return result;
}

/// Relaxes `start` to rest by the method of this name.
Relaxed relax(const std::string& method, const sand::HeightField& start, const sand::Rules& rules) {
    if (method == "N4") {
        return byFourNeighbours(start, rules);
    }
    if (method == "settle") {
        return bySettle(start, rules);
    }
    return swept(start, rules, method == "G" ? sand::Scheme::isotropic : sand::Scheme::plainIsotropic);
}

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

/// Returns the projection of `start` onto the fields without a quad steeper than the talus.
sand::HeightField projected(const sand::HeightField& start, const sand::Rules& rules) {
    sand::grid::DualProjection projection(start, rules);
    projection.run();
    sand::grid::NetFlux flux(start.columns(), start.rows());
    const sand::CellRect& box = projection.box();
    for (int y = box.y0; y < box.y1; ++y) {
        for (int x = box.x0; x < box.x1; ++x) {
            flux.east(y)[x] = projection.eastFlux(x, y);
            flux.north(y)[x] = projection.northFlux(x, y);
        }
    }
    sand::HeightField result = start;
    for (int y = 0; y < start.rows(); ++y) {
        for (int x = 0; x < start.columns(); ++x) {
            result.setHeight(x, y, start.height(x, y) + static_cast<std::int32_t>(flux.rise(x, y)));
        }
    }
    return result;
}

}  // namespace

void certificate(const Settings& settings, Csv& csv) {
    csv.note("bound: the certificate's bound of the squared distance to the projection of the start, over the squared");
    csv.note("  distance that was moved; truth: the squared distance itself, by a projection to a gap of 1e-5");
    csv.columns("pile,method,N,bound,truth");
    for (const int side : settings.sizes) {
        for (const Pile& pile : {lowPile(side), tallPile(side)}) {
            for (const char* name : {"G", "G plain", "N4", "settle"}) {
                progress("{} pile, N = {}, {}", pile.name, side, name);
                const sand::Rules rules = rulesFor(pile.start);
                const Relaxed rest = relax(name, pile.start, rules);
                const sand::grid::Certificate proof = sand::grid::certify(pile.start, rest.field, rest.flux, rules);
                const double truth = squaredDistance(projected(pile.start, rules), rest.field) / proof.squaredMoved;
                csv.row(pile.name, name, side, proof.relative(), truth);
            }
        }
    }
}

}  // namespace bench
