// SPDX-License-Identifier: Apache-2.0
#include "sand/grid/certificate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sand/grid/quad_energy.hpp"

namespace sand::grid {
namespace {

using Faces = QuadEnergy::Faces;

double dot(const Faces& a, const Faces& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]; }

/// Fluxes through the faces of each quad. A face that lies in two quads gives half of its flux to each.
class QuadFluxes {
public:
    QuadFluxes(const NetFlux& flux, const Rules& rules, double northing)
        : flux_(flux), open_(rules.rim == Rim::open), northing_(northing) {}

    [[nodiscard]] Faces operator()(int x, int y) const {
        return {east(x, y), east(x, y + 1), north(x, y) / northing_, north(x + 1, y) / northing_};
    }

private:
    /// Returns the quad's part of the flux from cell (x, y) to its eastern neighbour.
    [[nodiscard]] double east(int x, int y) const {
        const int rows = flux_.rows();
        if (open_) {
            return y < 0 || y >= rows ? 0 : 0.5 * static_cast<double>(flux_.east(y)[x]);
        }
        const double share = y == 0 || y == std::max(rows, 2) - 1 ? 1.0 : 0.5;
        return x + 1 >= flux_.columns() ? 0 : share * static_cast<double>(flux_.east(std::min(y, rows - 1))[x]);
    }
    [[nodiscard]] double north(int x, int y) const {
        const int columns = flux_.columns();
        if (open_) {
            return x < 0 || x >= columns ? 0 : 0.5 * static_cast<double>(flux_.north(y)[x]);
        }
        const double share = x == 0 || x == std::max(columns, 2) - 1 ? 1.0 : 0.5;
        return y + 1 >= flux_.rows() ? 0 : share * static_cast<double>(flux_.north(y)[std::min(x, columns - 1)]);
    }

    const NetFlux& flux_;
    bool open_;
    double northing_;  // divides the northern fluxes, so that V·D does not change
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
    const QuadEnergy asIs(rest, rules);
    QuadEnergy stable = asIs;
    stable.flatten(rules.tuning.threshold);
    const QuadFluxes fluxes(flux, rules, asIs.northing());
    double gap = 0;
    stable.forEach([&](int x, int y) {
        const Faces v = fluxes(x, y);
        // Sand flows downhill, so that a flux to the east belongs to a negative difference.
        gap += rules.tuning.threshold * std::numbers::sqrt2 * std::sqrt(dot(v, v)) + dot(v, stable.differences(x, y));
    });
    gap = std::max(gap / asIs.images(), 0.0);  // only rounding can make it negative
    const double squaredStep = stable.squaredDistanceTo(asIs) / asIs.images();
    const double distance = 0.5 * (std::sqrt(squaredStep) + std::sqrt(squaredStep + 4 * gap));
    return {.squaredDistance = distance * distance, .squaredMoved = squaredDistance(start, rest)};
}

}  // namespace sand::grid
