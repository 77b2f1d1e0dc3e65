// SPDX-License-Identifier: Apache-2.0
#include "sand/grid/settle.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "sand/grid/dual_projection.hpp"
#include "sand/grid/multigrid_start.hpp"

namespace sand::grid {
namespace {

constexpr std::int64_t kLeastWork = 1024;  // [cell], of a sweep that visits few cells

struct Extremes {
    std::int64_t least, greatest;  // [unit]
};

Extremes extremesOf(const HeightField& field) {
    Extremes result{field.height(0, 0), field.height(0, 0)};
    for (int y = 0; y < field.rows(); ++y) {
        const auto [least, greatest] = std::minmax_element(field.row(y), field.row(y) + field.columns());
        result.least = std::min<std::int64_t>(result.least, *least);
        result.greatest = std::max<std::int64_t>(result.greatest, *greatest);
    }
    return result;
}

bool isAtRest(const HeightField& field, const Rules& rules, base::CodePath path) {
    HeightField swept = field;
    Erosion(field, rules, {.path = path}).sweep(swept, 1);
    return sameHeights(swept, field);
}

/// Heights that may be outside the range of HeightField, and the fluxes that made them.
class Draft {
public:
    Draft(const HeightField& field, bool open)
        : columns_(field.columns()), rows_(field.rows()), open_(open), flux_(columns_, rows_) {
        for (int y = 0; y < rows_; ++y) {
            heights_.insert(heights_.end(), field.row(y), field.row(y) + columns_);
        }
    }

    void apply(const DualProjection& projection) {
        const int rim = open_ ? 1 : 0;
        for (int y = 0; y < rows_; ++y) {
            for (int x = -rim; x + 1 - rim < columns_; ++x) {
                flux_.east(y)[x] = projection.eastFlux(x, y);
            }
        }
        for (int y = -rim; y + 1 - rim < rows_; ++y) {
            for (int x = 0; x < columns_; ++x) {
                flux_.north(y)[x] = projection.northFlux(x, y);
            }
        }
        for (int y = 0; y < rows_; ++y) {
            for (int x = 0; x < columns_; ++x) {
                height(x, y) += flux_.rise(x, y);
            }
        }
    }

    /// Shares the surplus of cells beyond the extremes with their neighbours. Rounding, and errors that the last
    /// iteration left, may push a cell beyond them. Returns false if a cell is still beyond them after some rounds.
    [[nodiscard]] bool keepWithin(const Extremes& extremes) {
        constexpr int kRounds = 64;
        for (int round = 0; round < kRounds; ++round) {
            bool within = true;
            for (int y = 0; y < rows_; ++y) {
                for (int x = 0; x < columns_; ++x) {
                    const std::int64_t over =
                        height(x, y) - std::clamp(height(x, y), extremes.least, extremes.greatest);
                    if (over != 0) {
                        within = false;
                        share(x, y, over);
                    }
                }
            }
            if (within) {
                return true;
            }
        }
        return false;
    }

    /// Returns the volume that left over the rim [unit · cell].
    [[nodiscard]] std::int64_t outflow() const {
        std::int64_t sum = 0;
        for (int y = 0; y < rows_; ++y) {
            sum += flux_.east(y)[columns_ - 1] - flux_.east(y)[-1];
        }
        for (int x = 0; x < columns_; ++x) {
            sum += flux_.north(rows_ - 1)[x] - flux_.north(-1)[x];
        }
        return sum;
    }

    void store(HeightField& field, NetFlux* flux) const {
        for (int y = 0; y < rows_; ++y) {
            for (int x = 0; x < columns_; ++x) {
                field.setHeight(x, y, static_cast<std::int32_t>(heights_[index(x, y)]));
            }
        }
        if (flux != nullptr) {
            flux->add(flux_);
        }
    }

private:
    [[nodiscard]] std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(x);
    }
    std::int64_t& height(int x, int y) { return heights_[index(x, y)]; }

    /// Spreads `over` evenly over the neighbours of a cell. The remainder goes to the neighbours named first.
    void share(int x, int y, std::int64_t over) {
        const std::array<bool, 4> has{x > 0, x + 1 < columns_, y > 0, y + 1 < rows_};
        std::int64_t neighbours = std::count(has.begin(), has.end(), true);
        const auto next = [&](bool there) {
            const std::int64_t part = there ? over / neighbours-- : 0;
            over -= part;
            height(x, y) -= part;
            return part;
        };
        if (const std::int64_t part = next(has[0]); part != 0) {
            height(x - 1, y) += part;
            flux_.east(y)[x - 1] -= part;
        }
        if (const std::int64_t part = next(has[1]); part != 0) {
            height(x + 1, y) += part;
            flux_.east(y)[x] += part;
        }
        if (const std::int64_t part = next(has[2]); part != 0) {
            height(x, y - 1) += part;
            flux_.north(y - 1)[x] -= part;
        }
        if (const std::int64_t part = next(has[3]); part != 0) {
            height(x, y + 1) += part;
            flux_.north(y)[x] += part;
        }
    }

    int columns_, rows_;
    bool open_;
    std::vector<std::int64_t> heights_;  // [unit]
    NetFlux flux_;
};

/// Replaces the field by its projection, or leaves it unchanged if that is not possible.
void project(HeightField& field, const Rules& rules, NetFlux* flux, base::CodePath path, WorkLimit* limit,
             Settled& result) {
    Extremes extremes = extremesOf(field);
    const bool open = rules.rim == Rim::open;
    if (open && extremes.least < 0) {
        return;
    }
    DualProjection projection(field, rules, path);
    startFromCoarser(projection, field, rules, path, limit);
    const int iterations = projection.run(DualProjection::kRelativeGap, limit);
    Draft draft(field, open);
    draft.apply(projection);
    if (open) {
        extremes.least = 0;  // the height to which sand falls
    }
    if (draft.keepWithin(extremes)) {
        draft.store(field, flux);
        result.iterations = iterations;
        result.outflow = draft.outflow();
    }
}

}  // namespace

Settled settle(HeightField& field, const Rules& rules, NetFlux* flux, base::CodePath path, WorkLimit* limit) {
    Settled result;
    if (isAtRest(field, rules, path)) {
        return result;
    }
    project(field, rules, flux, path, limit, result);
    Rules toRest = rules;
    toRest.tuning.startThreshold = rules.tuning.threshold;
    Erosion erosion(field, toRest, {.path = path});
    const auto mayTake = [&] { return limit == nullptr || limit->take(std::max(erosion.activeCells(), kLeastWork)); };
    for (; !erosion.settled() && mayTake(); ++result.sweeps) {
        result.outflow += erosion.sweep(field, 1);
        if (flux != nullptr) {
            erosion.addFluxes(*flux);
        }
    }
    result.atRest = erosion.settled();
    return result;
}

}  // namespace sand::grid
