// SPDX-License-Identifier: Apache-2.0
// Measures how much sand floats lose or invent, beside integers.
#include <cmath>
#include <numeric>

#include "bench/report/curves.hpp"
#include "bench/sand/piles.hpp"
#include "bench/sand/relaxations.hpp"

namespace bench {
namespace {

/// Returns `field` with `cells` cells added to every height, as a survey's ground is above sea level.
sand::HeightField lifted(const sand::HeightField& field, int cells) {
    sand::HeightField result = field;
    for (int y = 0; y < field.rows(); ++y) {
        for (int x = 0; x < field.columns(); ++x) {
            result.setHeight(x, y, field.height(x, y) + cells * sand::kUnitsPerCell);
        }
    }
    return result;
}

}  // namespace

void massDrift(const Settings& settings, Csv& csv) {
    csv.note("datum: height of the ground [cell]; floats have 24 bits for datum and sand together");
    csv.note("drift: (volume above the datum - volume at the start) over the volume at the start");
    csv.columns("pile,method,N,datum,sweeps,drift");
    for (const int side : settings.sizes) {
        const Pile pile = lowPile(side);
        for (const int datum : {0, 1000}) {
            const sand::HeightField start = lifted(pile.start, datum);
            for (const Method& method : methods({"G", "float32 N4 in place", "float32 N4 Jacobi", "float32 N8 Jacobi",
                                                 "float32 N8 sqrt2 Jacobi"})) {
                progress("N = {}, datum {}, {}", side, datum, method.name);
                auto relaxation = method.start(start, rulesFor(start));
                const auto volume = [&] {
                    double sum = 0;
                    for (const double height : relaxation->heights()) {
                        sum += height - datum;  // doubles hold these differences exactly
                    }
                    return sum;
                };
                const double before = volume();
                std::int64_t done = 0;
                for (int wanted = 1; wanted <= 1 << 14 && !relaxation->atRest(); wanted *= 2) {
                    relaxation->sweep(wanted - static_cast<int>(done));
                    done = wanted;
                    csv.row(pile.name, method.name, side, datum, wanted, (volume() - before) / before);
                }
            }
        }
    }
}

}  // namespace bench
