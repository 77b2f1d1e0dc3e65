// SPDX-License-Identifier: Apache-2.0
#include "sand/grid/dunes.hpp"

#include <cmath>

namespace sand::grid {
namespace {

/// Returns a number in [0, 1) for each lattice point: an integer hash after Wang.
double lattice(std::int64_t x, std::int64_t y, std::uint32_t seed) {
    std::uint32_t h = static_cast<std::uint32_t>(x) * 0x9e3779b1U ^ static_cast<std::uint32_t>(y) * 0x85ebca77U ^ seed;
    h = (h ^ 61U ^ (h >> 16)) * 9U;
    h = (h ^ (h >> 4)) * 0x27d4eb2dU;
    return static_cast<double>(h ^ (h >> 15)) / 4294967296.0;
}

double smooth(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }

double mixed(double a, double b, double t) { return a + (b - a) * t; }

/// Returns smooth noise in [0, 1), with features of size 1.
double noise(double x, double y, std::uint32_t seed) {
    const double x0 = std::floor(x);
    const double y0 = std::floor(y);
    const auto i = static_cast<std::int64_t>(x0);
    const auto j = static_cast<std::int64_t>(y0);
    const double tx = smooth(x - x0);
    return mixed(mixed(lattice(i, j, seed), lattice(i + 1, j, seed), tx),
                 mixed(lattice(i, j + 1, seed), lattice(i + 1, j + 1, seed), tx), smooth(y - y0));
}

/// Returns the height of one dune at a phase in [0, 1): three quarters rise, one quarter falls.
double profile(double phase) {
    constexpr double kCrest = 0.75;
    return phase < kCrest ? smooth(phase / kCrest) : smooth((1 - phase) / (1 - kCrest));
}

}  // namespace

void makeDunes(const Dunes& dunes, HeightField& field) {
    const double cellsPerLength = dunes.length / field.cellSize();
    for (int row = 0; row < field.rows(); ++row) {
        for (int column = 0; column < field.columns(); ++column) {
            const double x = column / cellsPerLength;
            const double y = row / cellsPerLength;
            const double phase = x + 0.9 * noise(x * 0.4, y * 0.5, dunes.seed);
            const double crest = 0.35 + 0.65 * noise(x * 0.5 + 17, y * 0.8, dunes.seed + 1);
            const double height = dunes.bed + dunes.height * crest * profile(phase - std::floor(phase));
            field.setHeight(column, row, static_cast<std::int32_t>(std::floor(height / field.unit())));
        }
    }
}

}  // namespace sand::grid
