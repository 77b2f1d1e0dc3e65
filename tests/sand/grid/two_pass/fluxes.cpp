// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdlib>

#include "tests/sand/grid/two_pass/laws.hpp"

namespace two_pass {
namespace {

/// Masks of sliding cells in two parallel runs of cells; null without a band.
struct SlidingPair {
    const Sliding* behind;
    const Sliding* ahead;
};

template <class Law>
std::int32_t eitherOf(const Sliding* behind, const Sliding* ahead, int i) {
    if constexpr (Law::kBand) {
        return behind[i] | ahead[i];
    }
    return 0;
}

/// Computes the fluxes from a row of cells to their eastern neighbours. `south` and `north` are the rows beside it.
template <class Law>
void eastwards(const Law law, const std::int32_t* __restrict south, const std::int32_t* __restrict row,
               const std::int32_t* __restrict north, const SlidingPair& sliding, int count,
               std::int32_t* __restrict flux) {
    const Sliding* __restrict behind = sliding.behind;
    const Sliding* __restrict ahead = sliding.ahead;
    for (int i = 0; i < count; ++i) {
        const auto here = static_cast<float>(north[i] - south[i]);
        const auto there = static_cast<float>(north[i + 1] - south[i + 1]);
        flux[i] = law(row[i] - row[i + 1], here + there, flux[i], eitherOf<Law>(behind, ahead, i));
    }
}

/// Computes the fluxes from a row of cells to the row north of it.
template <class Law>
void northwards(const Law law, const std::int32_t* __restrict row, const std::int32_t* __restrict north,
                const SlidingPair& sliding, int count, std::int32_t* __restrict flux) {
    const Sliding* __restrict behind = sliding.behind;
    const Sliding* __restrict ahead = sliding.ahead;
    for (int i = 0; i < count; ++i) {
        const auto here = static_cast<float>(row[i + 1] - row[i - 1]);
        const auto there = static_cast<float>(north[i + 1] - north[i - 1]);
        flux[i] = law(row[i] - north[i], here + there, flux[i], eitherOf<Law>(behind, ahead, i));
    }
}

/// Fluxes of one patch. With `kLimited`, each face is computed by itself: the slope along it counts what its steps
/// count, and its flux has limits.
template <class Law, bool kLimited>
class Fluxes {
public:
    Fluxes(const FluxPatch& patch, const Law& east, const Law& north)
        : patch_(patch), eastLaw_(east), northLaw_(north), width_(patch.cells.x1 - patch.cells.x0) {}

    std::int64_t run() {
        if (patch_.cells.y0 == 0) {
            rimNorth(-1);
        }
        for (int y = patch_.cells.y0; y < patch_.cells.y1; ++y) {
            y == patch_.rows - 1 ? rimNorth(y) : northFluxes(y);
            eastFluxes(y);
        }
        return outflow_;
    }

private:
    /// Returns a pointer to the patch's first cell in row y.
    [[nodiscard]] const std::int32_t* heights(int y) const {
        return patch_.heights + (y - patch_.cells.y0) * patch_.heightStride;
    }
    [[nodiscard]] std::int32_t* east(int y) const { return patch_.east + y * patch_.fluxStride + patch_.cells.x0; }
    [[nodiscard]] std::int32_t* north(int y) const { return patch_.north + y * patch_.fluxStride + patch_.cells.x0; }
    /// Returns a pointer to the cell that is `ahead` cells after the patch's first cell in row y; null without a band.
    [[nodiscard]] const Sliding* sliding(int y, int ahead = 0) const {
        return Law::kBand ? patch_.sliding + y * patch_.slidingStride + patch_.cells.x0 + ahead : nullptr;
    }
    /// Returns a number of cell i of row y, counted from the patch's first cell.
    [[nodiscard]] std::int32_t held(const std::int32_t* numbers, int y, int i) const {
        return numbers[(y - patch_.cells.y0 + 1) * (width_ + 2) + 1 + i];
    }

    struct Cell {
        int y, i;
    };
    /// Returns the sand of the cell from which a face takes sand. `b` is another cell or, at a rim, the same one.
    [[nodiscard]] std::int32_t giverOf(const Cell& a, const Cell& b) const {
        const bool gives = heights(a.y)[a.i] > heights(b.y)[b.i];
        return gives ? held(patch_.sand, a.y, a.i) : held(patch_.sand, b.y, b.i);
    }
    /// Returns by how much `c` is higher than `d`, as a face counts it. docs/sand.md has the rule.
    [[nodiscard]] std::int32_t step(const Cell& c, const Cell& d, float start, std::int32_t giver) const {
        const std::int32_t height = heights(c.y)[c.i] - heights(d.y)[d.i];
        const Cell& upper = height > 0 ? c : d;
        const Cell& lower = height > 0 ? d : c;
        const std::int32_t fits = std::min(std::abs(height), held(patch_.room, lower.y, lower.i));
        const std::int32_t sand = held(patch_.sand, upper.y, upper.i);
        const auto up = static_cast<float>(std::min(fits, static_cast<std::int32_t>(start)));
        const float share = 4.0F / static_cast<float>(std::max(giver, 1));
        const auto thin = static_cast<std::int32_t>(up * std::min(static_cast<float>(sand) * share, 1.0F));
        const std::int32_t counted = std::max(std::min(fits, sand), thin);
        return height > 0 ? counted : -counted;
    }
    /// Returns how much higher the cell after `cell` is than the cell before it, to the east or to the north. Beyond
    /// the rim the step before it continues.
    [[nodiscard]] std::int32_t rise(const Cell& cell, bool toEast, std::int32_t giver) const {
        const int place = toEast ? patch_.cells.x0 + cell.i : cell.y, end = toEast ? patch_.columns : patch_.rows;
        if (end == 1) {
            return 0;
        }
        const float start = (toEast ? patch_.eastLaw : patch_.northLaw).startThreshold;
        const auto moved = [&](int by) { return toEast ? Cell{cell.y, cell.i + by} : Cell{cell.y + by, cell.i}; };
        const auto stepTo = [&](int by) { return step(moved(by), moved(by - 1), start, giver); };
        return place == 0 ? 2 * stepTo(1) : place == end - 1 ? 2 * stepTo(0) : stepTo(0) + stepTo(1);
    }
    /// Returns the flux from `a` to `b`.
    template <class AxisLaw>
    [[nodiscard]] std::int32_t between(const AxisLaw& law, const Cell& a, const Cell& b, bool toEast, std::int32_t last,
                                       std::int32_t slides) const {
        const std::int32_t giver = giverOf(a, b);
        const float along = static_cast<float>(rise(a, !toEast, giver)) + static_cast<float>(rise(b, !toEast, giver));
        const std::int32_t flux = law(heights(a.y)[a.i] - heights(b.y)[b.i], along, last, slides);
        const std::int32_t forth = std::min(held(patch_.room, b.y, b.i), held(patch_.sand, a.y, a.i)) / 4;
        const std::int32_t back = std::min(held(patch_.room, a.y, a.i), held(patch_.sand, b.y, b.i)) / 4;
        return std::max(std::min(flux, forth), -back);
    }

    /// Computes the fluxes from row y to row y + 1.
    void northFluxes(int y) {
        const SlidingPair slides{sliding(y), sliding(y + 1)};
        if constexpr (kLimited) {
            for (int i = 0; i < width_; ++i) {
                north(y)[i] = between(northLaw_, {y, i}, {y + 1, i}, false, north(y)[i],
                                      eitherOf<Law>(slides.behind, slides.ahead, i));
            }
        } else {
            northwards(northLaw_, heights(y), heights(y + 1), slides, width_, north(y));
        }
    }

    /// Computes the fluxes from the cells of row y to their eastern neighbours, and over the rims at the row's ends.
    void eastFluxes(int y) {
        std::int32_t* flux = east(y);
        const int last = width_ - 1;
        const bool endsAtRim = patch_.cells.x1 == patch_.columns;
        const std::int32_t lastAtRim = flux[last];
        const SlidingPair slides{sliding(y), sliding(y, 1)};
        if constexpr (kLimited) {
            for (int i = 0; i < width_ - (endsAtRim ? 1 : 0); ++i) {
                flux[i] =
                    between(eastLaw_, {y, i}, {y, i + 1}, true, flux[i], eitherOf<Law>(slides.behind, slides.ahead, i));
            }
        } else {
            eastwards(eastLaw_, heights(y - 1), heights(y), heights(y + 1), slides, width_, flux);
        }
        if (patch_.openRim && patch_.cells.x0 == 0) {
            flux[-1] = -overRim(eastLaw_, {y, 0}, false, -flux[-1]);
        }
        if (endsAtRim) {
            flux[last] = patch_.openRim ? overRim(eastLaw_, {y, last}, false, lastAtRim) : 0;
        }
    }

    void rimNorth(int y) {
        std::int32_t* flux = north(y);
        for (int i = 0; patch_.openRim && i < width_; ++i) {
            const Cell cell{std::max(y, 0), i};
            flux[i] = y < 0 ? -overRim(northLaw_, cell, true, -flux[i]) : overRim(northLaw_, cell, true, flux[i]);
        }
    }

    /// Returns the difference along the rim beside a cell.
    [[nodiscard]] std::int32_t riseAtRim(const Cell& cell, bool toEast) const {
        if constexpr (kLimited) {
            return rise(cell, toEast, giverOf(cell, cell));
        } else {
            return toEast ? heights(cell.y)[cell.i + 1] - heights(cell.y)[cell.i - 1]
                          : heights(cell.y + 1)[cell.i] - heights(cell.y - 1)[cell.i];
        }
    }
    /// Returns the flux over an open rim, where sand falls to height 0 and never comes back. `toEast` is the direction
    /// along the rim.
    std::int32_t overRim(const Law& law, const Cell& cell, bool toEast, std::int32_t last) {
        const std::int32_t slides = Law::kBand ? sliding(cell.y)[cell.i] : 0;
        const float along = 2 * static_cast<float>(riseAtRim(cell, toEast));
        std::int32_t flux = std::max(law(heights(cell.y)[cell.i], along, last, slides), 0);
        if constexpr (kLimited) {
            flux = std::min(flux, held(patch_.sand, cell.y, cell.i) / 4);
        }
        outflow_ += flux;
        return flux;
    }

    const FluxPatch& patch_;
    const Law eastLaw_, northLaw_;
    const int width_;
    std::int64_t outflow_ = 0;
};

template <class Law>
std::int64_t run(const FluxPatch& patch, const Law& east, const Law& north) {
    return patch.sand != nullptr ? Fluxes<Law, true>(patch, east, north).run()
                                 : Fluxes<Law, false>(patch, east, north).run();
}

template <bool kBand>
std::int64_t runWithBand(const FluxPatch& patch) {
    if (!patch.inertial) {
        using Law = Isotropic<kBand>;
        return run(patch, Law{patch.eastLaw}, Law{patch.northLaw});
    }
    using Law = Inertial<kBand>;
    return run(patch, Law(patch.eastLaw, patch.momentum), Law(patch.northLaw, patch.momentum));
}

}  // namespace

std::int64_t sweepFluxes(const FluxPatch& patch) {
    return patch.sliding != nullptr ? runWithBand<true>(patch) : runWithBand<false>(patch);
}

}  // namespace two_pass
