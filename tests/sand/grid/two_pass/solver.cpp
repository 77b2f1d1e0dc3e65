// SPDX-License-Identifier: Apache-2.0
#include "tests/sand/grid/two_pass/solver.hpp"

#include <algorithm>
#include <optional>

#include "sand/grid/flux_limits.hpp"
#include "sand/model/momentum.hpp"
#include "tests/sand/grid/two_pass/kernel.hpp"

namespace two_pass {
namespace {

/// Returns the law's constants for the faces across one axis. `ratio` is the length of a cell across these faces,
/// divided by its length along them. The thresholds are differences from cell to cell [unit].
AxisLaw axisLaw(sand::Scheme scheme, double threshold, double startThreshold, double ratio) {
    // The proofs end at 0.5; 0.4998 leaves room for the rounding of float products. Near 0.5 a chequerboard oscillates
    // without damping. With inertia, a steep needle would become too flat: 17 % of its sand would be misplaced, and 0.8
    // % with 0.46.
    const double limit = (scheme == sand::Scheme::isotropic ? 0.46 : 0.4998) / (ratio * ratio + 1);
    // As strong as linear stability allows, minus a tenth. Near the threshold, 1 - t²/m² is twice 1 - t/m. Along both
    // axes, equal slopes give equal fluxes.
    const double push = 0.225 * std::min(1.0, 1 / (ratio * ratio));
    return {static_cast<float>(threshold), static_cast<float>(startThreshold), static_cast<float>(limit),
            static_cast<float>(push), static_cast<float>(0.25 * ratio)};
}

/// Continues the slope of the ground into the ghost cells.
void refreshGhosts(sand::HeightField& field) {
    const int columns = field.columns(), rows = field.rows();
    for (int x = 0; x < columns; ++x) {
        field.row(-1)[x] = 2 * field.row(0)[x] - field.row(std::min(1, rows - 1))[x];
        field.row(rows)[x] = 2 * field.row(rows - 1)[x] - field.row(std::max(rows - 2, 0))[x];
    }
    for (int y = 0; y < rows; ++y) {
        std::int32_t* const row = field.row(y);
        row[-1] = 2 * row[0] - row[std::min(1, columns - 1)];
        row[columns] = 2 * row[columns - 1] - row[std::max(columns - 2, 0)];
    }
}

bool hasBand(const sand::Rules& rules) { return rules.tuning.startThreshold > rules.tuning.threshold; }

}  // namespace

void Solver::sweep(int sweeps) {
    bool moves = true;
    for (int n = 0; n < sweeps && moves; ++n) {
        refreshGhosts(field);
        const float momentum = std::max(sand::momentumAfter<float>(n, sand::dampingOf(sweeps)),
                                        sand::momentumAfter<float>(undisturbed, sand::kMostDamping));
        forEachPatch([&](const sand::CellRect& cells) { sweepFluxes(cells, momentum); });
        moves = false;
        forEachPatch([&](const sand::CellRect& cells) { moves = balance(cells) || moves; });
        undisturbed = std::min(undisturbed + (moves ? 1 : 0), 1000);
    }
}

template <class Task>
void Solver::forEachPatch(const Task& task) const {
    constexpr int kHeight = 128;  // [cell]
    for (int y = 0; y < field.rows(); y += kHeight) {
        for (int x = 0; x < field.columns(); x += kMaxPatch) {
            task(sand::CellRect{x, y, x + kMaxPatch, y + kHeight}.clippedTo(field.bounds()));
        }
    }
}

void Solver::sweepFluxes(const sand::CellRect& cells, float momentum) {
    std::optional<sand::grid::FluxLimits> limits;
    if (tool != nullptr || ground_ != nullptr) {
        limits.emplace(field, cells, ground_, tool);
    }
    const bool grounded = ground_ != nullptr;
    const int limitsWidth = cells.x1 - cells.x0 + 2;
    const double ratio = static_cast<double>(rules.aspect) / sand::kUnitsPerCell;
    outflow += two_pass::sweepFluxes(
        {.heights = grounded ? limits->heights.data() + limitsWidth + 1 : field.row(cells.y0) + cells.x0,
         .heightStride = grounded ? limitsWidth : field.stride(),
         .east = east_.row(0),
         .north = north_.row(0),
         .fluxStride = east_.stride(),
         .cells = cells,
         .columns = field.columns(),
         .rows = field.rows(),
         .eastLaw = axisLaw(rules.scheme, rules.tuning.threshold, rules.tuning.startThreshold, 1 / ratio),
         .northLaw = axisLaw(rules.scheme, rules.tuning.threshold * ratio, rules.tuning.startThreshold * ratio, ratio),
         .momentum = momentum,
         .inertial = rules.scheme == sand::Scheme::isotropic,
         .openRim = rules.rim == sand::Rim::open,
         .sliding = hasBand(rules) ? sliding_.row(0) : nullptr,
         .slidingStride = sliding_.stride(),
         .room = limits ? limits->room.data() : nullptr,
         .sand = grounded ? limits->sand.data() : nullptr});
}

bool Solver::balance(const sand::CellRect& cells) {
    // Writes the masks without a band, too, because a later change of the rules may bring one.
    return two_pass::balance({.heights = field.row(0),
                              .heightStride = field.stride(),
                              .east = east_.row(0),
                              .north = north_.row(0),
                              .fluxStride = east_.stride(),
                              .sliding = sliding_.row(0),
                              .slidingStride = sliding_.stride(),
                              .cells = cells});
}

}  // namespace two_pass
