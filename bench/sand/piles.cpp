// SPDX-License-Identifier: Apache-2.0
#include "bench/sand/piles.hpp"

#include <cmath>
#include <limits>
#include <random>

namespace bench {
namespace {

Pile pile(const std::string& name, int side, double radius, double height) {
    const oracles::Cylinder shape(radius, height);
    const double centre = side / 2.0;
    return {name, shape,
            oracles::fieldOf(side, side, oracles::around(centre, centre, [&](double r) { return shape.start(r); })),
            oracles::sampled(side, side, oracles::around(centre, centre, [&](double r) { return shape.rest(r); }))};
}

}  // namespace

Pile lowPile(int side) { return pile("low", side, 0.3 * side, 0.18 * side); }

Pile tallPile(int side) { return pile("tall", side, 0.25 * side, 0.5 * side); }

std::vector<Pile> pilesOf(int side) {
    std::vector<Pile> piles{lowPile(side)};
    if (side <= kLargestTall) {
        piles.push_back(tallPile(side));
    }
    return piles;
}

sand::HeightField bumpySlope(int side, std::uint32_t seed) {
    std::mt19937 random(seed);
    sand::HeightField field(side, side, 1.0);
    // The heights are around 0, so that the largest field of the benchmarks stays within their range.
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const int bump = static_cast<int>(random() % (sand::kUnitsPerCell / 2));
            field.setHeight(x, y, 3 * (x - side / 2) * sand::kUnitsPerCell + bump);
        }
    }
    return field;
}

double misplaced(const std::vector<double>& a, const std::vector<double>& b) {
    double error = 0;
    double total = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        error += std::abs(a[i] - b[i]);
        total += std::abs(b[i]);
    }
    return total > 0 ? error / total : error;
}

double misplaced(const sand::HeightField& a, const sand::HeightField& b) {
    std::int64_t error = 0;
    std::int64_t total = 0;
    for (int y = 0; y < a.rows(); ++y) {
        for (int x = 0; x < a.columns(); ++x) {
            error += std::abs(std::int64_t{a.height(x, y)} - b.height(x, y));
            total += std::abs(std::int64_t{b.height(x, y)});
        }
    }
    return total > 0 ? static_cast<double>(error) / static_cast<double>(total) : static_cast<double>(error);
}

double observedOrder(double coarseError, int coarse, double fineError, int fine) {
    return coarseError > 0 && fineError > 0 && coarse > 0
               ? std::log(coarseError / fineError) / std::log(static_cast<double>(fine) / coarse)
               : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace bench
