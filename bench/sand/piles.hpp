// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sand/model/height_field.hpp"
#include "tests/support/oracles.hpp"

namespace bench {

/// A cylinder of sand in a box around it, talus 45 degrees, and the pile it must become.
struct Pile {
    std::string name;
    oracles::Cylinder shape;
    sand::HeightField start;
    std::vector<double> rest;  // [cell], means over the cells

    [[nodiscard]] int side() const { return start.columns(); }
    [[nodiscard]] double centre() const { return start.columns() / 2.0; }
};

/// Height over radius 0.6: it keeps a flat top. The radius is 0.3 of the side.
[[nodiscard]] Pile lowPile(int side);
/// Height over radius 2: it becomes a cone. The radius is 0.25 of the side.
[[nodiscard]] Pile tallPile(int side);

/// Both, or the low one alone where the tall one would take plain G minutes: beyond a side of kLargestTall.
[[nodiscard]] std::vector<Pile> pilesOf(int side);
inline constexpr int kLargestTall = 256;  // [cell]

/// A plane three times as steep as the talus in a closed box, with bumps of half a cell from a generator seeded with
/// `seed`: every cell of it moves.
[[nodiscard]] sand::HeightField bumpySlope(int side, std::uint32_t seed);

/// Sum of |a - b| over the sum of |b| [1].
[[nodiscard]] double misplaced(const std::vector<double>& a, const std::vector<double>& b);
[[nodiscard]] double misplaced(const sand::HeightField& a, const sand::HeightField& b);

/// Order of convergence between two sizes: log of the errors' ratio over log of the sizes'. NaN where it has none:
/// without a first size, or of errors that are zero.
[[nodiscard]] double observedOrder(double coarseError, int coarse, double fineError, int fine);

}  // namespace bench
