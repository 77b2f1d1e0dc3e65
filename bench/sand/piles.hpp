// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sand/model/height_field.hpp"
#include "tests/support/sand/oracles.hpp"

namespace bench {

/// A cylinder of sand in a box, and the pile that it must become with a talus of 45 degrees.
struct Pile {
    std::string name;
    oracles::Cylinder shape;
    sand::HeightField start;
    std::vector<double> rest;  // means over the cells at rest [cell]

    [[nodiscard]] int side() const { return start.columns(); }
    [[nodiscard]] double centre() const { return start.columns() / 2.0; }
};

/// Returns a cylinder whose height is 0.6 radii; its pile keeps a flat top. The radius is 0.3 of the side.
[[nodiscard]] Pile lowPile(int side);
/// Returns a cylinder whose height is 2 radii; its pile is a cone. The radius is 0.25 of the side.
[[nodiscard]] Pile tallPile(int side);

/// Returns both piles. Beyond a side of kLargestTall, returns only the low pile, because the tall one would take plain
/// G minutes.
[[nodiscard]] std::vector<Pile> pilesOf(int side);
inline constexpr int kLargestTall = 256;  // [cell]
/// Beyond this side only G and settle run to rest, because the other methods would take an hour.
inline constexpr int kLargestSlow = 512;  // [cell]

/// Returns a plane three times as steep as the talus, with bumps of up to half a cell from a generator
/// seeded with `seed`. Every cell of it moves in a closed box.
[[nodiscard]] sand::HeightField bumpySlope(int side, std::uint32_t seed);

/// Returns the sum of |a - b| over the sum of |b| [1].
[[nodiscard]] double misplaced(const std::vector<double>& a, const std::vector<double>& b);
[[nodiscard]] double misplaced(const sand::HeightField& a, const sand::HeightField& b);

/// Returns the order of convergence between two sizes: log of the errors' ratio over log of the sizes' ratio. Returns
/// NaN if `coarse` or an error is 0.
[[nodiscard]] double observedOrder(double coarseError, int coarse, double fineError, int fine);

}  // namespace bench
