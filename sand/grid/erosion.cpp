// SPDX-License-Identifier: Apache-2.0
#include "sand/grid/erosion.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <utility>

#include "sand/model/momentum.hpp"

namespace sand::grid {
namespace {

/// Continues the slope of the ground into the ghost cells. The slope along the rim at a cell then equals the slope to
/// its one neighbour along this axis.
void extrapolate(const std::int32_t* edge, const std::int32_t* inner, std::ptrdiff_t stride, int count,
                 std::int32_t* ghost) {
    for (int i = 0; i < count; ++i, edge += stride, inner += stride, ghost += stride) {
        *ghost = 2 * *edge - *inner;
    }
}

/// Writes the ghost cells next to `cells` so that the field's slope continues across the rim.
void refreshGhosts(HeightField& field, const CellRect& cells) {
    const int columns = field.columns();
    const int rows = field.rows();
    const CellRect reach = cells.grownBy(1).clippedTo(field.bounds());
    const auto ghostRow = [&](int ghost, int edge, int inner) {
        extrapolate(field.row(edge) + reach.x0, field.row(inner) + reach.x0, 1, reach.x1 - reach.x0,
                    field.row(ghost) + reach.x0);
    };
    const auto ghostColumn = [&](int ghost, int edge, int inner) {
        std::int32_t* const first = field.row(reach.y0);
        extrapolate(first + edge, first + inner, field.stride(), reach.y1 - reach.y0, first + ghost);
    };
    if (cells.y0 == 0) {
        ghostRow(-1, 0, std::min(1, rows - 1));
    }
    if (cells.y1 == rows) {
        ghostRow(rows, rows - 1, std::max(rows - 2, 0));
    }
    if (cells.x0 == 0) {
        ghostColumn(-1, 0, std::min(1, columns - 1));
    }
    if (cells.x1 == columns) {
        ghostColumn(columns, columns - 1, std::max(columns - 2, 0));
    }
}

/// Returns the law's constants for the faces across one axis. `ratio` is the length of a cell across these faces,
/// divided by its length along them. The thresholds are differences from cell to cell [unit].
AxisLaw axisLaw(Scheme scheme, double threshold, double startThreshold, double ratio) {
    // The proofs end at 0.5; 0.4998 leaves room for the rounding of float products. Near 0.5 a chequerboard oscillates
    // without damping. With inertia, a steep needle would become too flat: 17 % of its sand would be misplaced, and 0.8
    // % with 0.46.
    const double limit = (scheme == Scheme::isotropic ? 0.46 : 0.4998) / (ratio * ratio + 1);
    // As strong as linear stability allows, minus a tenth. Near the threshold, 1 - t²/m² is twice 1 - t/m. Along both
    // axes, equal slopes give equal fluxes.
    const double push = 0.225 * std::min(1.0, 1 / (ratio * ratio));
    return {static_cast<float>(threshold), static_cast<float>(startThreshold), static_cast<float>(limit),
            static_cast<float>(push), static_cast<float>(0.25 * ratio)};
}

}  // namespace

Erosion::Erosion(const HeightField& field, const Rules& rules, const Options& options)
    : rules_(rules),
      options_(options),
      blockSize_(std::clamp(options.blockSize, 2, kMaxBlock)),
      across_((field.columns() + blockSize_ - 1) / blockSize_),
      down_((field.rows() + blockSize_ - 1) / blockSize_),
      east_(field.columns(), field.rows()),
      north_(field.columns(), field.rows()),
      written_(static_cast<std::size_t>(down_), Written::no),
      marked_(across_, down_),
      moved_(across_, down_),
      flowed_(across_, down_) {
    wakeAll();
}

std::size_t Erosion::bytes() const {
    return east_.bytes() + north_.bytes() + written_.size() + marked_.bytes() + moved_.bytes() + flowed_.bytes() +
           walk_.bytes() + (active_.capacity() + swept_.capacity()) * sizeof active_[0] +
           steep_.capacity() * sizeof steep_[0];
}

Erosion::Swept Erosion::sweep(HeightField& field, const SweepPart& part, const Obstacle* obstacle,
                              const std::function<void(const CellRect&)>& willChange) {
    packed_.reset();
    wakeTouched();
    std::int64_t outflow = 0;
    for (int n = 0; n < part.sweeps && !settled(); ++n) {
        const float momentum = std::max(momentumAfter<float>(part.first + n, dampingOf(part.whole)),
                                        momentumAfter<float>(undisturbed_, kMostDamping));
        leaveOutResting(field);
        swept_.clear();
        for (const CellRect& run : active_) {
            swept_.push_back(cellsOf(run));
        }
        if (willChange) {
            std::for_each(swept_.begin(), swept_.end(), willChange);
        }
        noteWritten();
        outflow += swept_.empty() ? 0 : sweepOnce(field, momentum, obstacle);
        markAroundMoved();
        ++sweepsDone_;
        const bool still = marked_.empty();
        if (!still) {  // a replica that joins settled sand visits it once, which must not change its age
            undisturbed_ = std::min(undisturbed_ + 1, Inertia::kMostCounted);
        }
        active_ = marked_.takeRuns();
        if (!options_.skipSettled && !still) {
            wakeAll();
        }
    }
    releaseRest();
    // If no block is active, the next sweep would move no sand. A replica that was healed visits all blocks to find
    // that.
    return {outflow, settled()};
}

std::int64_t Erosion::sweepOnce(HeightField& field, float momentum, const Obstacle* obstacle) {
    for (const CellRect& cells : swept_) {
        refreshGhosts(field, cells);
    }
    const double ratio = static_cast<double>(rules_.aspect) / kUnitsPerCell;
    const bool holds = obstacle != nullptr && !obstacle->cells.empty() && options_.ground == nullptr;
    const std::optional<HeldFaces> held = holds ? std::optional(HeldFaces{*obstacle}) : std::nullopt;
    const Sweep sweep{
        .heights = field.row(0),
        .heightStride = field.stride(),
        .east = east_.row(0),
        .north = north_.row(0),
        .fluxStride = east_.stride(),
        .columns = field.columns(),
        .rows = field.rows(),
        .blockSize = blockSize_,
        .eastLaw = axisLaw(rules_.scheme, rules_.tuning.threshold, rules_.tuning.startThreshold, 1 / ratio),
        .northLaw =
            axisLaw(rules_.scheme, rules_.tuning.threshold * ratio, rules_.tuning.startThreshold * ratio, ratio),
        .momentum = momentum,
        .inertial = rules_.scheme == Scheme::isotropic,
        .band = rules_.tuning.startThreshold > rules_.tuning.threshold,
        .openRim = rules_.rim == Rim::open,
        .held = held ? &*held : nullptr,
        .flowed = flowed_.row(0),
        .flowedStride = flowed_.stride()};
    return walk_.sweep(sweep, swept_,
                       {.field = field,
                        .ground = options_.ground,
                        .obstacle = obstacle,
                        .executor = options_.executor,
                        .path = options_.path});
}

void Erosion::addFluxes(NetFlux& sum) const {
    const auto add = [](const std::int32_t* flux, std::int64_t* to, int from, int end) {
        for (int i = from; i < end; ++i) {
            to[i] += flux[i];
        }
    };
    for (const CellRect& cells : swept_) {  // no sand flowed anywhere else
        for (int y = cells.y0; y < cells.y1; ++y) {
            add(east_.row(y), sum.east(y), cells.x0 == 0 ? -1 : cells.x0, cells.x1);
        }
        for (int y = cells.y0 == 0 ? -1 : cells.y0; y < cells.y1; ++y) {
            add(north_.row(y), sum.north(y), cells.x0, cells.x1);
        }
    }
}

Inertia Erosion::inertia() const {
    if (!packed_) {
        packed_ = packedInertia();
    }
    return *packed_;
}

Inertia Erosion::packedInertia() const {
    Inertia inertia(undisturbed_);
    const TileGrid grid(east_.bounds());
    const std::vector<bool> flows = tilesWithFlux(grid);
    for (std::size_t tile = 0; tile < flows.size(); ++tile) {
        // Keeps the fluxes even at age 0, when they carry no momentum: a band depends on where sand slid.
        if (flows[tile]) {
            addFluxes(grid.cellsOf(tile), inertia);
        }
    }
    return inertia;
}

std::vector<bool> Erosion::tilesWithFlux(const TileGrid& grid) const {
    std::vector<bool> flows(grid.count());
    for (const CellRect& run : active_) {
        grid.forEach(cellsOf(run), [&flows](std::size_t tile) { flows[tile] = true; });
    }
    return flows;
}

void Erosion::addFluxes(CellRect cells, Inertia& inertia) const {
    cells.x0 -= cells.x0 == 0 ? 1 : 0;  // flux over the western rim
    cells.y0 -= cells.y0 == 0 ? 1 : 0;
    inertia.keep(east_, north_, cells);
}

void Erosion::resume(const Inertia& inertia) {
    packed_.reset();
    for (CellArray* flux : {&east_, &north_}) {
        *flux = CellArray(flux->columns(), flux->rows());
    }
    std::fill(written_.begin(), written_.end(), Written::no);
    inertia.putInto(east_, north_);
    inertia.visitAreas([this](const CellRect& cells) {
        // A flux to the north of the last row also changes the row beyond it.
        const int first = std::max(cells.y0, 0) / blockSize_, last = std::min(cells.y1 / blockSize_, down_ - 1);
        std::fill(written_.begin() + first, written_.begin() + last + 1, Written::lately);
    });
    undisturbed_ = inertia.undisturbed();
    // A sweep in which an executor threw has left numbers there.
    flowed_ = FlowBits(across_, down_);
    walk_ = ErosionWalk();
    wakeAll();
}

void Erosion::changeRules(const Rules& rules) {
    rules_ = rules;
    touch(east_.bounds());
}

bool Erosion::amiss(const CellRect& cells) const {
    const auto rests = [this](int x, int y) {
        const int column = x / blockSize_, row = y / blockSize_;
        // The last run that begins at this block or before it.
        const auto after = std::upper_bound(
            active_.begin(), active_.end(), std::pair(row, column),
            [](const std::pair<int, int>& block, const CellRect& run) { return block < std::pair(run.y0, run.x0); });
        return after == active_.begin() || std::prev(after)->y0 != row || std::prev(after)->x1 <= column;
    };
    for (int x = cells.x0; cells.y0 == 0 && x < cells.x1; ++x) {  // over the southern rim
        if (north_.row(-1)[x] != 0 && rests(x, 0)) {
            return true;
        }
    }
    for (int y = cells.y0; y < cells.y1; ++y) {
        if (cells.x0 == 0 && east_.row(y)[-1] != 0 && rests(0, y)) {  // over the western rim
            return true;
        }
        std::int32_t flows = 0;  // joins the whole row, because nearly all memory holds 0
        for (int x = cells.x0; x < cells.x1; ++x) {
            flows |= east_.row(y)[x] | north_.row(y)[x];
        }
        for (int x = cells.x0; flows != 0 && x < cells.x1; ++x) {
            if ((east_.row(y)[x] | north_.row(y)[x]) != 0 && rests(x, y)) {
                return true;
            }
        }
    }
    return false;
}

}  // namespace sand::grid
