// SPDX-License-Identifier: Apache-2.0
// Compiled once for every x86-64 and once for x86-64-v3, with -O3: g++ 12 does not vectorise these loops at -O2.
#include "sand/erosion_kernel.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace sand::SANDWALL_CODE_PATH {
namespace {

using Fluxes = std::array<std::int32_t, kMaxBlock + 1>;  // [unit] through consecutive faces, towards east or north

/// Scheme G of NUMERICS: isotropic, the default. Slope across the face from its two cells, slope along it as the mean
/// of the four differences beside it; `alongA` and `alongB` are the sums of the two differences of either cell.
struct Isotropic {
    // 0.2499 and not 0.25: the float product must not round above the proven bound.
    static constexpr float kShare = 0.2499F;
    float threshold, startThreshold;

    explicit Isotropic(const BlockSweep& block)
        : threshold(static_cast<float>(block.threshold)), startThreshold(static_cast<float>(block.startThreshold)) {}

    std::int32_t operator()(std::int32_t a, std::int32_t b, std::int32_t alongA, std::int32_t alongB) const {
        const auto across = static_cast<float>(a - b);
        const float along = 0.25F * (static_cast<float>(alongA) + static_cast<float>(alongB));
        const float slope = std::sqrt(across * across + along * along);
        const float share = slope > startThreshold ? kShare * (1.0F - threshold / slope) : 0.0F;
        return static_cast<std::int32_t>(share * across);
    }
};

/// Scheme N4: each pair of neighbours by itself, integers only. A preview: it rests in the wrong pile.
struct FourNeighbours {
    std::int32_t threshold, startThreshold;

    explicit FourNeighbours(const BlockSweep& block)
        : threshold(block.threshold), startThreshold(block.startThreshold) {}

    std::int32_t operator()(std::int32_t a, std::int32_t b, std::int32_t, std::int32_t) const {
        const std::int32_t difference = a - b;
        const std::int32_t size = difference < 0 ? -difference : difference;
        const std::int32_t flux = size > startThreshold ? (size - threshold + 3) / 4 : 0;
        return difference < 0 ? -flux : flux;
    }
};

template <class Scheme, bool kTool>
class Sweep {
public:
    Sweep(const BlockSweep& block, std::int64_t& outflow)
        : block_(block), scheme_(block), outflow_(outflow), width_(block.cells.x1 - block.cells.x0) {}

    bool run() {
        Fluxes south;
        Fluxes north;
        Fluxes across;
        northFluxes(block_.cells.y0 - 1, south);
        std::int32_t changed = 0;
        for (int y = block_.cells.y0; y < block_.cells.y1; ++y) {
            northFluxes(y, north);
            eastFluxes(y, across);
            const std::int32_t* in = rowOf(y);
            std::int32_t* out = block_.out + y * block_.stride + block_.cells.x0;
            for (int i = 0; i < width_; ++i) {
                const auto at = static_cast<std::size_t>(i);
                const std::int32_t change = across[at] - across[at + 1] + south[at] - north[at];
                out[i] = in[i] + change;
                changed |= change;
            }
            south = north;
        }
        return changed != 0;
    }

private:
    /// The block's first cell in row y.
    [[nodiscard]] const std::int32_t* rowOf(int y) const {
        return block_.in + y * block_.stride + block_.cells.x0;
    }
    [[nodiscard]] const std::int32_t* roomOf(int y) const {
        return block_.room + (y - block_.cells.y0 + 1) * (width_ + 2) + 1;
    }
    static std::int32_t limit(std::int32_t flux, std::int32_t roomBehind, std::int32_t roomAhead) {
        return std::max(std::min(flux, roomAhead), -roomBehind);
    }
    /// Over an open rim sand falls to height 0 and never comes back.
    [[nodiscard]] std::int32_t overRim(std::int32_t height, std::int32_t along) const {
        return std::max(scheme_(height, 0, along, along), 0);
    }

    /// Fluxes from row y to row y + 1, one per column of the block.
    void northFluxes(int y, Fluxes& flux) {
        const std::int32_t* here = rowOf(y);
        if (y < 0 || y == block_.rows - 1) {
            rimNorth(y, flux);
            return;
        }
        const std::int32_t* there = here + block_.stride;
        for (int i = 0; i < width_; ++i) {
            flux[static_cast<std::size_t>(i)] =
                scheme_(here[i], there[i], here[i + 1] - here[i - 1], there[i + 1] - there[i - 1]);
        }
        if constexpr (kTool) {
            for (int i = 0; i < width_; ++i) {
                std::int32_t& q = flux[static_cast<std::size_t>(i)];
                q = limit(q, roomOf(y)[i], roomOf(y + 1)[i]);
            }
        }
    }

    void rimNorth(int y, Fluxes& flux) {
        flux.fill(0);
        if (!block_.openRim) {
            return;
        }
        const std::int32_t* inner = rowOf(std::max(y, 0));
        for (int i = 0; i < width_; ++i) {
            const std::int32_t q = overRim(inner[i], inner[i + 1] - inner[i - 1]);
            flux[static_cast<std::size_t>(i)] += y < 0 ? -q : q;
            outflow_ += q;
        }
    }

    /// Fluxes through the vertical faces of row y: index i lies between cells i - 1 and i of the block.
    void eastFluxes(int y, Fluxes& flux) {
        const std::int32_t* here = rowOf(y);
        const std::int32_t* above = here + block_.stride;
        const std::int32_t* below = here - block_.stride;
        const bool westRim = block_.cells.x0 == 0;
        const bool eastRim = block_.cells.x1 == block_.columns;
        for (int i = westRim ? 1 : 0; i < width_ + (eastRim ? 0 : 1); ++i) {
            flux[static_cast<std::size_t>(i)] =
                scheme_(here[i - 1], here[i], above[i - 1] - below[i - 1], above[i] - below[i]);
        }
        if constexpr (kTool) {
            for (int i = westRim ? 1 : 0; i < width_ + (eastRim ? 0 : 1); ++i) {
                std::int32_t& q = flux[static_cast<std::size_t>(i)];
                q = limit(q, roomOf(y)[i - 1], roomOf(y)[i]);
            }
        }
        if (westRim) {
            const std::int32_t q = block_.openRim ? overRim(here[0], above[0] - below[0]) : 0;
            flux[0] = -q;
            outflow_ += q;
        }
        if (eastRim) {
            const int last = width_ - 1;
            const std::int32_t q = block_.openRim ? overRim(here[last], above[last] - below[last]) : 0;
            flux[static_cast<std::size_t>(width_)] = q;
            outflow_ += q;
        }
    }

    const BlockSweep& block_;
    const Scheme scheme_;
    std::int64_t& outflow_;
    const int width_;
};

}  // namespace

bool sweepBlock(const BlockSweep& block, std::int64_t& outflow) {
    if (block.n4) {
        return block.room != nullptr ? Sweep<FourNeighbours, true>(block, outflow).run()
                                     : Sweep<FourNeighbours, false>(block, outflow).run();
    }
    return block.room != nullptr ? Sweep<Isotropic, true>(block, outflow).run()
                                 : Sweep<Isotropic, false>(block, outflow).run();
}

}  // namespace sand::SANDWALL_CODE_PATH
