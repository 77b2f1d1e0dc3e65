// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "tests/sand/grid/two_pass/laws.hpp"

namespace two_pass {
namespace {

/// Buffer of one number per cell of a patch's row, and one more before and behind. It is left uninitialised, because
/// rows are long.
template <class Number>
struct alignas(64) Row {
    std::array<Number, kMaxPatch + 2 * kKernelMargin> values;
    Number* data() { return values.data() + kKernelMargin; }
};

/// Computes the differences for the slope along a face. A step counts at most the sand of its upper cell. Otherwise a
/// bare cliff would make stable sand beside it slide.
void sandDifferences(const std::int32_t* __restrict a, const std::int32_t* __restrict b,
                     const std::int32_t* __restrict sandA, const std::int32_t* __restrict sandB, int count,
                     std::int32_t* __restrict result) {
    for (int i = 0; i < count; ++i) {
        result[i] = std::max(std::min(a[i] - b[i], sandA[i]), -sandB[i]);
    }
}

void sums(const std::int32_t* __restrict a, const std::int32_t* __restrict b, int count, float* __restrict result) {
    for (int i = 0; i < count; ++i) {
        result[i] = static_cast<float>(a[i] + b[i]);
    }
}

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

/// Computes the fluxes between two parallel runs of cells. `alongA` and `alongB` hold each cell's sum of two
/// differences along the faces.
template <class Law>
void fluxesBetween(const Law law, const std::int32_t* __restrict a, const std::int32_t* __restrict b,
                   const float* __restrict alongA, const float* __restrict alongB, const SlidingPair& sliding,
                   int count, std::int32_t* __restrict flux) {
    const Sliding* __restrict behind = sliding.behind;
    const Sliding* __restrict ahead = sliding.ahead;
    for (int i = 0; i < count; ++i) {
        flux[i] = law(a[i] - b[i], alongA[i] + alongB[i], flux[i], eitherOf<Law>(behind, ahead, i));
    }
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

/// Limits each flux to the room of the cell that receives it.
void limitToRoom(const std::int32_t* __restrict behind, const std::int32_t* __restrict ahead, int count,
                 std::int32_t* __restrict flux) {
    for (int i = 0; i < count; ++i) {
        flux[i] = std::max(std::min(flux[i], ahead[i]), -behind[i]);
    }
}

/// Limits each flux to a quarter of the sand in the cell that gives it. Its four faces then never take more than it
/// has, so that the thickness never becomes negative.
void limitToSand(const std::int32_t* __restrict behind, const std::int32_t* __restrict ahead, int count,
                 std::int32_t* __restrict flux) {
    for (int i = 0; i < count; ++i) {
        flux[i] = std::max(std::min(flux[i], behind[i] / 4), -(ahead[i] / 4));
    }
}

/// Fluxes of one patch. With `kSandAlong`, the slope along a face counts only the sand and not the ground below it.
template <class Law, bool kSandAlong>
class Fluxes {
public:
    Fluxes(const FluxPatch& patch, const Law& east, const Law& north)
        : patch_(patch), eastLaw_(east), northLaw_(north), width_(patch.cells.x1 - patch.cells.x0) {}

    std::int64_t run() {
        if constexpr (kSandAlong) {
            riseEast(patch_.cells.y0);
        }
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
    /// Returns a pointer to the patch's first cell in row y of `room` or `sand`.
    [[nodiscard]] const std::int32_t* held(const std::int32_t* numbers, int y) const {
        return numbers + (y - patch_.cells.y0 + 1) * (width_ + 2) + 1;
    }

    /// Computes for each cell of row y how much higher its eastern neighbour is than its western one, counting only
    /// sand.
    void riseEast(int y) {
        const std::int32_t* sand = held(patch_.sand, y) - 1;
        sandDifferences(heights(y), heights(y) - 1, sand + 1, sand, width_ + 1, steps_[0].data());
        sums(steps_[0].data(), steps_[0].data() + 1, width_, riseEast_[static_cast<unsigned>(y) % 2].data());
    }
    /// Computes for each cell of row y, and for one more, how much higher its northern neighbour is than its southern
    /// one, counting only sand.
    void riseNorth(int y) {
        const int count = width_ + 1;
        const std::int32_t* sand = held(patch_.sand, y);
        const int up = width_ + 2;
        sandDifferences(heights(y), heights(y - 1), sand, sand - up, count, steps_[0].data());
        sandDifferences(heights(y + 1), heights(y), sand + up, sand, count, steps_[1].data());
        sums(steps_[0].data(), steps_[1].data(), count, riseNorth_.data());
    }

    /// Limits the fluxes from the cells of row y to the cells that are `ahead` places further in `room` and `sand`.
    void hold(int y, int ahead, std::int32_t* flux) const {
        if (patch_.room != nullptr) {
            limitToRoom(held(patch_.room, y), held(patch_.room, y) + ahead, width_, flux);
        }
        if (patch_.sand != nullptr) {
            limitToSand(held(patch_.sand, y), held(patch_.sand, y) + ahead, width_, flux);
        }
    }

    /// Computes the fluxes from row y to row y + 1.
    void northFluxes(int y) {
        if constexpr (kSandAlong) {
            riseEast(y + 1);
            fluxesBetween(northLaw_, heights(y), heights(y + 1), riseEast_[static_cast<unsigned>(y) % 2].data(),
                          riseEast_[static_cast<unsigned>(y + 1) % 2].data(), {sliding(y), sliding(y + 1)}, width_,
                          north(y));
        } else {
            northwards(northLaw_, heights(y), heights(y + 1), {sliding(y), sliding(y + 1)}, width_, north(y));
        }
        hold(y, width_ + 2, north(y));
    }

    /// Computes the fluxes from the cells of row y to their eastern neighbours, and over the rims at the row's ends.
    void eastFluxes(int y) {
        std::int32_t* flux = east(y);
        // The face at the rim is computed like the others and corrected below. A row whose number of faces is a
        // multiple of eight then has no remainder, which would take longer than all other faces.
        const std::int32_t lastAtRim = flux[width_ - 1];
        if constexpr (kSandAlong) {
            riseNorth(y);
            fluxesBetween(eastLaw_, heights(y), heights(y) + 1, riseNorth_.data(), riseNorth_.data() + 1,
                          {sliding(y), sliding(y, 1)}, width_, flux);
        } else {
            eastwards(eastLaw_, heights(y - 1), heights(y), heights(y + 1), {sliding(y), sliding(y, 1)}, width_, flux);
        }
        hold(y, 1, flux);
        if (patch_.openRim && patch_.cells.x0 == 0) {
            flux[-1] = -overRim(eastLaw_, y, 0, riseNorthOf(y, 0), -flux[-1]);
        }
        if (patch_.cells.x1 == patch_.columns) {
            const int last = width_ - 1;
            flux[last] = patch_.openRim ? overRim(eastLaw_, y, last, riseNorthOf(y, last), lastAtRim) : 0;
        }
    }

    void rimNorth(int y) {
        if (!patch_.openRim) {
            return;
        }
        const int inner = std::max(y, 0);
        std::int32_t* flux = north(y);
        for (int i = 0; i < width_; ++i) {
            const float along = riseEastOf(inner, i);
            flux[i] =
                y < 0 ? -overRim(northLaw_, inner, i, along, -flux[i]) : overRim(northLaw_, inner, i, along, flux[i]);
        }
    }

    /// Returns for one cell the number that riseEast() computes for all cells of a row.
    [[nodiscard]] float riseEastOf(int y, int i) const {
        if constexpr (kSandAlong) {
            return riseEast_[static_cast<unsigned>(y) % 2].values[static_cast<unsigned>(i + kKernelMargin)];
        } else {
            return static_cast<float>(heights(y)[i + 1] - heights(y)[i - 1]);
        }
    }
    /// Returns for one cell the number that riseNorth() computes for all cells of a row.
    [[nodiscard]] float riseNorthOf(int y, int i) const {
        if constexpr (kSandAlong) {
            return riseNorth_[static_cast<unsigned>(i)];
        } else {
            return static_cast<float>(heights(y + 1)[i] - heights(y - 1)[i]);
        }
    }

    /// Returns the flux over an open rim, where sand falls to height 0 and never comes back. `rise` is the difference
    /// along the rim beside the cell.
    std::int32_t overRim(const Law& law, int y, int i, float rise, std::int32_t last) {
        const std::int32_t slides = Law::kBand ? sliding(y)[i] : 0;
        std::int32_t flux = std::max(law(heights(y)[i], 2 * rise, last, slides), 0);
        if (patch_.sand != nullptr) {
            flux = std::min(flux, held(patch_.sand, y)[i] / 4);
        }
        outflow_ += flux;
        return flux;
    }

    const FluxPatch& patch_;
    const Law eastLaw_, northLaw_;
    const int width_;
    std::int64_t outflow_ = 0;
    // Numbers for even and odd rows. The arrays are empty if slopes are taken from the heights themselves.
    std::array<Row<float>, kSandAlong ? 2 : 0> riseEast_;
    std::array<Row<std::int32_t>, kSandAlong ? 2 : 0> steps_;
    std::array<float, kSandAlong ? kMaxPatch + 2 * kKernelMargin : 0> riseNorth_;
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
