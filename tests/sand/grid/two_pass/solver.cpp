// SPDX-License-Identifier: Apache-2.0
#include "tests/sand/grid/two_pass/solver.hpp"

#include <algorithm>
#include <vector>

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

constexpr std::int32_t kEndless = 1 << 30;  // [unit], more than any flux or step needs

/// Heights, sand and room of a patch and of one more cell on every side, row by row.
struct LimitedPatch {
    std::vector<std::int32_t> heights, sand, room;  // [unit]

    LimitedPatch(const sand::HeightField& field, const sand::CellRect& cells, const sand::Ground* ground,
                 const sand::grid::Obstacle* tool) {
        for (int y = cells.y0 - 1; y <= cells.y1; ++y) {
            for (int x = cells.x0 - 1; x <= cells.x1; ++x) {
                const int u = std::clamp(x, 0, field.columns() - 1), v = std::clamp(y, 0, field.rows() - 1);
                const bool wall = ground != nullptr && ground->isWall(u, v);
                const std::int32_t height = field.height(u, v);
                heights.push_back(wall ? sand::kMaxHeight : height);
                sand.push_back(ground == nullptr ? kEndless : ground->sand(u, v, height));
                room.push_back(wall ? 0 : roomBelow(tool, u, v, height));
            }
        }
    }

private:
    static std::int32_t roomBelow(const sand::grid::Obstacle* tool, int x, int y, std::int32_t height) {
        const bool reaches = tool != nullptr && !sand::CellRect{x, y, x + 1, y + 1}.clippedTo(tool->cells).empty();
        const std::int32_t under = reaches ? tool->row(y)[x - tool->cells.x0] : sand::grid::Obstacle::kFree;
        return under == sand::grid::Obstacle::kFree ? kEndless
                                                    : std::max(std::min(under, sand::kMaxHeight) - height, 0);
    }
};

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
    const bool limited = tool != nullptr || ground_ != nullptr;
    std::vector<LimitedPatch> limits;
    if (limited) {
        limits.emplace_back(field, cells, ground_, tool);
    }
    const int limitsWidth = cells.x1 - cells.x0 + 2;
    const double ratio = static_cast<double>(rules.aspect) / sand::kUnitsPerCell;
    outflow += two_pass::sweepFluxes(
        {.heights = limited ? limits[0].heights.data() + limitsWidth + 1 : field.row(cells.y0) + cells.x0,
         .heightStride = limited ? limitsWidth : field.stride(),
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
         .room = limited ? limits[0].room.data() : nullptr,
         .sand = limited ? limits[0].sand.data() : nullptr});
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
