// SPDX-License-Identifier: Apache-2.0
#include "sand/grid/multigrid_start.hpp"

#include <algorithm>
#include <array>

namespace sand::grid {
namespace {

constexpr int kLeastSide = 32;  // [cell]; a field this small is projected at once
// Smaller than the gap of the fine cells. An iteration there costs four times as much, and moving a whole slope takes
// many. A tilted plane of 256² cells needed 800 iterations after this gap and 1120 after 1e-4, and a sixth of the
// sweeps.
constexpr double kCoarseGap = 1e-6;

/// Returns the mean heights of 2 × 2 cells in units of the wider cell. A last column or row without a partner is
/// averaged alone.
HeightField coarser(const HeightField& field) {
    HeightField result((field.columns() + 1) / 2, (field.rows() + 1) / 2, 2 * field.cellSize());
    for (int y = 0; y < result.rows(); ++y) {
        const std::int32_t* south = field.row(2 * y);
        const std::int32_t* north = field.row(std::min(2 * y + 1, field.rows() - 1));
        for (int x = 0; x < result.columns(); ++x) {
            const int west = 2 * x;
            const int east = std::min(west + 1, field.columns() - 1);
            const std::int64_t sum = std::int64_t{south[west]} + south[east] + north[west] + north[east];
            result.setHeight(x, y, static_cast<std::int32_t>(sum / 8));
        }
    }
    return result;
}

}  // namespace

CellRect DualProjection::pressedCells() const {
    CellRect pressed{box_.x1, box_.y1, box_.x0, box_.y0};
    for (int y = box_.y0; y + 1 < box_.y1; ++y) {
        for (int x = box_.x0; x + 1 < box_.x1; ++x) {
            if (pressure(0, x, y) != 0 || pressure(1, x, y) != 0 || pressure(2, x, y) != 0) {
                pressed = {std::min(pressed.x0, x), std::min(pressed.y0, y), std::max(pressed.x1, x + 2),
                           std::max(pressed.y1, y + 2)};
            }
        }
    }
    return pressed;
}

void DualProjection::allocateFor(const DualProjection& coarse) {
    const CellRect pressed = coarse.pressedCells();
    if (!pressed.empty()) {
        const CellRect reached =
            CellRect{2 * pressed.x0 - 1, 2 * pressed.y0 - 1, 2 * pressed.x1 + 1, 2 * pressed.y1 + 1}
                .grownBy(2 * kMargin)
                .clippedTo(domain_);
        allocate({std::min(reached.x0, box_.x0), std::min(reached.y0, box_.y0), std::max(reached.x1, box_.x1),
                  std::max(reached.y1, box_.y1)});
    }
}

void DualProjection::startFrom(const DualProjection& coarse) {
    if (atRest()) {
        return;
    }
    allocateFor(coarse);
    // A pressure is an area, so that it is four times as large in cells half as wide. Its third component acts along
    // the twist of a quad. The twist is a second difference: compared with the slope, it is half as large in the
    // narrower cells.
    constexpr std::array<double, 3> kScales{4, 4, 2};
    // Every second quad lies where four wide cells meet. The others lie half-way between two such places.
    const auto before = [](int i) { return (i + 1) / 2 - 1; };
    const auto after = [](int i) { return (i + 2) / 2 - 1; };
    for (std::size_t i = 0; i < kScales.size(); ++i) {
        for (int y = box_.y0; y + 1 < box_.y1; ++y) {
            const auto inColumn = [&](int x) {
                return coarse.pressureBeyond(i, x, before(y)) + coarse.pressureBeyond(i, x, after(y));
            };
            const std::ptrdiff_t row = (y - box_.y0) * stride_ - box_.x0;
            for (int x = box_.x0; x + 1 < box_.x1; ++x) {
                now_[i][row + x] = 0.25 * kScales[i] * (inColumn(before(x)) + inColumn(after(x)));
                before_[i][row + x] = now_[i][row + x];
            }
        }
    }
}

double DualProjection::pressureBeyond(std::size_t component, int column, int row) const {
    // No sand passes a closed rim. Along the rim, sand slides as it does in the row or column beside it.
    if (rules_.rim == Rim::closed && component == 0) {
        row = std::clamp(row, domain_.y0, domain_.y1 - 2);
    }
    if (rules_.rim == Rim::closed && component == 1) {
        column = std::clamp(column, domain_.x0, domain_.x1 - 2);
    }
    return pressure(component, column, row);
}

void startFromCoarser(DualProjection& projection, const HeightField& field, const Rules& rules, base::CodePath path,
                      WorkLimit* limit) {
    if (std::max(field.columns(), field.rows()) <= kLeastSide) {
        return;
    }
    const HeightField mean = coarser(field);
    Rules meanRules = rules;
    meanRules.columns = mean.columns();
    meanRules.rows = mean.rows();
    DualProjection coarse(mean, meanRules, path);
    startFromCoarser(coarse, mean, meanRules, path, limit);
    coarse.run(kCoarseGap, limit);
    projection.startFrom(coarse);
}

}  // namespace sand::grid
