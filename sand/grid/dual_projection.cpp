// SPDX-License-Identifier: Apache-2.0
#include "sand/grid/dual_projection.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/code_path.hpp"

namespace sand::grid {
namespace {

// Largest excess of a quad's slope at the end, as a share of the talus. A gap may be small only because it changes its
// sign. With 0.01, as many sweeps followed.
constexpr double kRelativeExcess = 0.03;
constexpr double kIterationsPerCell = 40;  // per cell of the box's width and height; the slowest known start needed 4
constexpr double kLeastExcess = 4.0 / kUnitsPerCell;  // [cell], excess that the sweeps leave

std::int64_t rounded(double flux) { return static_cast<std::int64_t>(flux < 0 ? flux - 0.5 : flux + 0.5); }

/// Returns the cells of the projection. A field one cell wide is solved beside its mirror image, because quads need two
/// cells.
CellRect domainOf(const HeightField& field, Rim rim) {
    if (rim == Rim::open) {
        return field.bounds().grownBy(1);
    }
    return {0, 0, std::max(field.columns(), 2), std::max(field.rows(), 2)};
}

}  // namespace

DualProjection::DualProjection(const HeightField& field, const Rules& rules, base::CodePath path)
    : field_(field),
      rules_(rules),
      path_(path),
      northing_(static_cast<double>(kUnitsPerCell) / rules.aspect),
      twist_(std::max(northing_, 1.0)),
      domain_(domainOf(field, rules.rim)) {
    const CellRect steep = steepQuads();
    if (!steep.empty()) {
        allocate(steep.grownBy(2 * kMargin).clippedTo(domain_));
    }
}

std::int32_t DualProjection::startHeight(int column, int row) const {
    if (rules_.rim == Rim::open) {
        const CellRect cell = CellRect{column, row, column + 1, row + 1}.clippedTo(field_.bounds());
        return cell.empty() ? 0 : field_.height(column, row);
    }
    return field_.height(std::min(column, field_.columns() - 1), std::min(row, field_.rows() - 1));
}

CellRect DualProjection::steepQuads() const {
    CellRect steep{domain_.x1, domain_.y1, domain_.x0, domain_.y0};
    for (int y = domain_.y0; y + 1 < domain_.y1; ++y) {
        for (int x = domain_.x0; x + 1 < domain_.x1; ++x) {
            const double a = startHeight(x, y);
            const double b = startHeight(x + 1, y);
            const double c = startHeight(x, y + 1);
            const double d = startHeight(x + 1, y + 1);
            const double east = b - a + (d - c);
            const double north = northing_ * (c - a + (d - b));
            const double twist = twist_ * (d - c - (b - a));
            if (std::sqrt(east * east + north * north + twist * twist) > 2.0 * rules_.tuning.threshold) {
                steep = {std::min(steep.x0, x), std::min(steep.y0, y), std::max(steep.x1, x + 2),
                         std::max(steep.y1, y + 2)};
            }
        }
    }
    return steep;
}

void DualProjection::allocate(const CellRect& box) {
    box_ = box;
    const int columns = box.x1 - box.x0;
    const int rows = box.y1 - box.y0;
    stride_ = (columns + kDualLanes - 1) / kDualLanes * kDualLanes + 2 * kDualLanes;
    for (auto& array : arrays_) {
        array.assign(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(rows), 0.0);
    }
    for (auto& sums : sums_) {
        sums.assign(static_cast<std::size_t>(stride_), 0.0);
    }
    scratch_.resize(static_cast<std::size_t>(stride_) * kDualRows);
    for (std::size_t i = 0; i < 3; ++i) {
        now_[i] = arrays_[1 + i].data() + kDualLanes;
        before_[i] = arrays_[4 + i].data() + kDualLanes;
    }
    for (int y = 0; y < rows; ++y) {
        double* start = arrays_[0].data() + kDualLanes + y * stride_;
        for (int x = 0; x < columns; ++x) {
            start[x] = static_cast<double>(startHeight(box.x0 + x, box.y0 + y)) / kUnitsPerCell;
        }
    }
}

bool DualProjection::iterate(double momentum, Measures* measures) {
    for (auto& sums : sums_) {
        std::fill(sums.begin(), sums.end(), 0.0);
    }
    const bool open = rules_.rim == Rim::open;
    const DualIteration iteration{.columns = box_.x1 - box_.x0,
                                  .rows = box_.y1 - box_.y0,
                                  .stride = stride_,
                                  .start = arrays_[0].data() + kDualLanes,
                                  .now = now_,
                                  .before = before_,
                                  .momentum = momentum,
                                  .step = 0.25 / (twist_ * twist_),
                                  .threshold = (1 - kTalusSlack) * rules_.tuning.threshold / kUnitsPerCell,
                                  .northing = northing_,
                                  .twist = twist_,
                                  .heldWest = open && box_.x0 == domain_.x0,
                                  .heldEast = open && box_.x1 == domain_.x1,
                                  .heldSouth = open && box_.y0 == domain_.y0,
                                  .heldNorth = open && box_.y1 == domain_.y1,
                                  .scratch = scratch_.data(),
                                  .turn = sums_[0].data(),
                                  .measure = measures != nullptr,
                                  .gap = sums_[1].data(),
                                  .moved = sums_[2].data(),
                                  .excess = sums_[3].data()};
    path_ != base::CodePath::baseline ? v3::iterateDual(iteration) : baseline::iterateDual(iteration);
    std::swap(now_, before_);
    const auto sum = [&](const std::vector<double>& sums, int count) {
        return std::accumulate(sums.begin(), sums.begin() + count, 0.0);
    };
    if (measures != nullptr) {
        measures->gap = sum(sums_[1], iteration.columns - 1);
        measures->moved = sum(sums_[2], iteration.columns);
        measures->excess = *std::max_element(sums_[3].begin(), sums_[3].begin() + iteration.columns - 1);
    }
    return sum(sums_[0], iteration.columns - 1) > 0;
}

int DualProjection::run(double relativeGap, WorkLimit* limit) {
    const double enough = std::max(kRelativeExcess * rules_.tuning.threshold / kUnitsPerCell, kLeastExcess);
    double weight = 1;  // t of Beck and Teboulle
    double momentum = 0;
    bool wasClose = false;
    int iterations = 0;
    const double longest = kIterationsPerCell * std::max(northing_, 1 / northing_);
    while (!atRest() && iterations < longest * (box_.x1 - box_.x0 + box_.y1 - box_.y0)) {
        const std::int64_t cells = std::int64_t{box_.x1 - box_.x0} * (box_.y1 - box_.y0);
        if (limit != nullptr && !limit->take(kCost * cells)) {
            break;
        }
        ++iterations;
        const bool check = iterations % kCheckEvery == 0;
        Measures measures;
        if (iterate(momentum, check ? &measures : nullptr)) {
            weight = 1;
        }
        const double next = 0.5 * (1 + std::sqrt(1 + 4 * weight * weight));
        momentum = (weight - 1) / next;
        weight = next;
        if (check) {
            const bool isClose = std::abs(measures.gap) <= relativeGap * measures.moved && measures.excess <= enough;
            if (isClose && wasClose) {
                break;
            }
            wasClose = isClose;
            if (nearEdge()) {
                grow();
            }
        }
    }
    return iterations;
}

bool DualProjection::nearEdge() const {
    const auto pressed = [this](const CellRect& quads) {
        for (int y = quads.y0; y < quads.y1; ++y) {
            for (int x = quads.x0; x < quads.x1; ++x) {
                if (pressure(0, x, y) != 0 || pressure(1, x, y) != 0 || pressure(2, x, y) != 0) {
                    return true;
                }
            }
        }
        return false;
    };
    CellRect inner = box_;  // no cell lies beyond an edge of the domain, so that it needs no margin
    inner.x0 += box_.x0 == domain_.x0 ? 0 : kMargin;
    inner.y0 += box_.y0 == domain_.y0 ? 0 : kMargin;
    inner.x1 -= box_.x1 == domain_.x1 ? 0 : kMargin + 1;
    inner.y1 -= box_.y1 == domain_.y1 ? 0 : kMargin + 1;
    return pressed({box_.x0, box_.y0, inner.x0, box_.y1}) || pressed({inner.x1, box_.y0, box_.x1, box_.y1}) ||
           pressed({inner.x0, box_.y0, inner.x1, inner.y0}) || pressed({inner.x0, inner.y1, inner.x1, box_.y1});
}

void DualProjection::grow() {
    const CellRect old = box_;
    const std::ptrdiff_t oldStride = stride_;
    const std::array<std::vector<double>, 7> oldArrays = std::move(arrays_);
    const bool swapped = now_[0] != oldArrays[1].data() + kDualLanes;
    arrays_ = {};
    allocate(old.grownBy(kMargin).clippedTo(domain_));
    if (swapped) {
        std::swap(now_, before_);
    }
    for (std::size_t i = 1; i < arrays_.size(); ++i) {
        for (int y = old.y0; y + 1 < old.y1; ++y) {
            const auto from = oldArrays[i].begin() + kDualLanes + (y - old.y0) * oldStride;
            std::copy(from, from + (old.x1 - old.x0 - 1),
                      arrays_[i].begin() + kDualLanes + (y - box_.y0) * stride_ + (old.x0 - box_.x0));
        }
    }
}

double DualProjection::pressure(std::size_t component, int column, int row) const {
    const bool inside = column >= box_.x0 && row >= box_.y0 && column + 1 < box_.x1 && row + 1 < box_.y1;
    return inside ? now_[component][(row - box_.y0) * stride_ + column - box_.x0] : 0;
}

std::int64_t DualProjection::eastFlux(int column, int row) const {
    const double mean = 0.5 * (pressure(0, column, row - 1) + pressure(0, column, row));
    const double twist = 0.25 * twist_ * (pressure(2, column, row - 1) - pressure(2, column, row));
    return rounded(-kUnitsPerCell * (mean + twist));
}

std::int64_t DualProjection::northFlux(int column, int row) const {
    const double mean = 0.5 * northing_ * (pressure(1, column - 1, row) + pressure(1, column, row));
    const double twist = 0.25 * twist_ * (pressure(2, column - 1, row) - pressure(2, column, row));
    return rounded(-kUnitsPerCell * (mean + twist));
}

}  // namespace sand::grid
