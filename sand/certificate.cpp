// SPDX-License-Identifier: Apache-2.0
#include "sand/certificate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace sand {
namespace {

/// Faces of a quad: southern, northern, western, eastern; differences and fluxes are positive towards east and north.
using Faces = std::array<double, 4>;

double dot(const Faces& a, const Faces& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]; }

/// The quads of a field. Around an open field lies a ring of cells at height 0; one that is a single cell wide lies
/// beside its mirror image, since quads need two.
class Quads {
public:
    Quads(const HeightField& rest, const NetFlux& flux, const Rules& rules)
        : rest_(rest),
          flux_(flux),
          ring_(rules.rim == Rim::open ? 1 : 0),
          columns_(rest.columns()),
          rows_(rest.rows()),
          northing_(static_cast<double>(kUnitsPerCell) / rules.aspect) {}

    /// Calls visit(differences, fluxes) for every quad, row by row. Faces that lie in two quads give half to each.
    template <class Visit>
    void forEach(Visit visit) const {
        for (int y = -ring_; y < lastRow(); ++y) {
            for (int x = -ring_; x < lastColumn(); ++x) {
                visit(differences(x, y), fluxes(x, y));
            }
        }
    }

    /// How often a cell counts: twice beside its mirror image.
    [[nodiscard]] double images() const {
        return ring_ == 1 ? 1.0 : (columns_ == 1 ? 2.0 : 1.0) * (rows_ == 1 ? 2.0 : 1.0);
    }

private:
    // Of the westernmost and southernmost cell of the last quads.
    [[nodiscard]] int lastColumn() const { return ring_ == 1 ? columns_ : std::max(columns_, 2) - 1; }
    [[nodiscard]] int lastRow() const { return ring_ == 1 ? rows_ : std::max(rows_, 2) - 1; }

    [[nodiscard]] double height(int x, int y) const {
        if (ring_ == 1) {
            return x < 0 || y < 0 || x >= columns_ || y >= rows_ ? 0 : rest_.height(x, y);
        }
        return rest_.height(std::min(x, columns_ - 1), std::min(y, rows_ - 1));
    }

    /// What a quad is given of the flux from cell (x, y) to its eastern neighbour.
    [[nodiscard]] double east(int x, int y) const {
        if (ring_ == 1) {
            return y < 0 || y >= rows_ ? 0 : 0.5 * static_cast<double>(flux_.east(y)[x]);
        }
        const double share = y == 0 || y == std::max(rows_, 2) - 1 ? 1.0 : 0.5;
        return x + 1 >= columns_ ? 0 : share * static_cast<double>(flux_.east(std::min(y, rows_ - 1))[x]);
    }
    [[nodiscard]] double north(int x, int y) const {
        if (ring_ == 1) {
            return x < 0 || x >= columns_ ? 0 : 0.5 * static_cast<double>(flux_.north(y)[x]);
        }
        const double share = x == 0 || x == std::max(columns_, 2) - 1 ? 1.0 : 0.5;
        return y + 1 >= rows_ ? 0 : share * static_cast<double>(flux_.north(y)[std::min(x, columns_ - 1)]);
    }

    [[nodiscard]] Faces differences(int x, int y) const {
        const double a = height(x, y);
        const double b = height(x + 1, y);
        const double c = height(x, y + 1);
        const double d = height(x + 1, y + 1);
        return {b - a, d - c, northing_ * (c - a), northing_ * (d - b)};
    }
    [[nodiscard]] Faces fluxes(int x, int y) const {
        return {east(x, y), east(x, y + 1), north(x, y) / northing_, north(x + 1, y) / northing_};
    }

    const HeightField& rest_;
    const NetFlux& flux_;
    int ring_;
    int columns_, rows_;
    double northing_;  // slope north per difference, over slope east per difference: V·D stays what it is
};

double squaredDistance(const HeightField& a, const HeightField& b) {
    double sum = 0;
    for (int y = 0; y < a.rows(); ++y) {
        for (int x = 0; x < a.columns(); ++x) {
            const double change = static_cast<double>(a.height(x, y)) - b.height(x, y);
            sum += change * change;
        }
    }
    return sum;
}

}  // namespace

Certificate certify(const HeightField& start, const HeightField& rest, const NetFlux& flux, const Rules& rules) {
    const Quads quads(rest, flux, rules);
    double steepest = rules.threshold;
    quads.forEach([&](const Faces& differences, const Faces&) {
        steepest = std::max(steepest, std::sqrt(0.5 * dot(differences, differences)));
    });
    double lengths = 0;
    double descents = 0;
    quads.forEach([&](const Faces& differences, const Faces& fluxes) {
        lengths += std::numbers::sqrt2 * std::sqrt(dot(fluxes, fluxes));
        // Sand flows downhill: a flux east belongs to a difference below zero.
        descents -= dot(fluxes, differences);
    });
    return {.squaredDistance = (steepest * lengths - descents) / quads.images(),
            .gap = (rules.threshold * lengths - descents) / quads.images(),
            .squaredMoved = squaredDistance(start, rest),
            .steepest = steepest};
}

}  // namespace sand
