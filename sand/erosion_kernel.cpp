// SPDX-License-Identifier: Apache-2.0
// Compiled once for every x86-64 and once for x86-64-v3, with -O3: g++ 12 does not vectorise these loops at -O2.
#include "sand/erosion_kernel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace sand::SANDWALL_CODE_PATH {
namespace {

// Loops over a row do whole vectors: the cells and faces behind its end cost less than a remainder one by one.
constexpr int kLanes = 8;
constexpr int wholeVectors(int count) { return (count + kLanes - 1) / kLanes * kLanes; }

/// A number per cell or face of a row of the patch; left uninitialised, since blocks are small and rows long.
template <class Number>
struct alignas(64) Row {
    std::array<Number, kMaxPatch + 2 * kLanes> values;
    Number* data() { return values.data(); }
    Number& operator[](int i) { return values[static_cast<std::size_t>(i)]; }
};
using Fluxes = Row<std::int32_t>;  // [unit] through consecutive faces, towards east or north

/// Scheme G of NUMERICS: isotropic, the default. Slope across the face from its two cells, slope along it as the mean
/// of the four differences beside it, whose sum is `along`.
struct Isotropic {
    static constexpr bool kNeedsAlong = true;
    // 0.2499 and not 0.25: the float product must not round above the proven bound.
    static constexpr float kShare = 0.2499F;
    float threshold, startThreshold;

    explicit Isotropic(const PatchSweep& patch)
        : threshold(static_cast<float>(patch.threshold)), startThreshold(static_cast<float>(patch.startThreshold)) {}

    std::int32_t operator()(std::int32_t difference, float along) const {
        const auto across = static_cast<float>(difference);
        const float mean = 0.25F * along;
        const float slope = std::sqrt(across * across + mean * mean);
        const float share = slope > startThreshold ? kShare * (1.0F - threshold / slope) : 0.0F;
        return static_cast<std::int32_t>(share * across);
    }
};

/// Scheme N4: each pair of neighbours by itself, integers only. A preview: it rests in the wrong pile.
struct FourNeighbours {
    static constexpr bool kNeedsAlong = false;
    std::int32_t threshold, startThreshold;

    explicit FourNeighbours(const PatchSweep& patch)
        : threshold(patch.threshold), startThreshold(patch.startThreshold) {}

    std::int32_t operator()(std::int32_t difference, float) const {
        const std::int32_t size = difference < 0 ? -difference : difference;
        const std::int32_t flux = size > startThreshold ? (size - threshold + 3) / 4 : 0;
        return difference < 0 ? -flux : flux;
    }
};

// Free functions on restricted pointers, and a copy of the scheme: with members in reach g++ keeps the loops scalar.

void differences(const std::int32_t* __restrict a, const std::int32_t* __restrict b, int count,
                 float* __restrict result) {
    for (int i = 0; i < count; ++i) {
        result[i] = static_cast<float>(a[i] - b[i]);
    }
}

/// The fluxes between two parallel runs of cells, given the sum of the two differences along the faces of either cell.
template <class Scheme>
void fluxesBetween(const Scheme scheme, const std::int32_t* __restrict a, const std::int32_t* __restrict b,
                   const float* __restrict alongA, const float* __restrict alongB, int count,
                   std::int32_t* __restrict flux) {
    for (int i = 0; i < count; ++i) {
        flux[i] = scheme(a[i] - b[i], alongA[i] + alongB[i]);
    }
}

/// Lets no flux bring more than there is room for, behind it or ahead.
void limit(const std::int32_t* __restrict roomBehind, const std::int32_t* __restrict roomAhead, int count,
           std::int32_t* __restrict flux) {
    for (int i = 0; i < count; ++i) {
        flux[i] = std::max(std::min(flux[i], roomAhead[i]), -roomBehind[i]);
    }
}

/// Takes a row's fluxes from its cells. `changed` collects the bits that changed in each column, so that blocks are
/// looked at once and not in every row.
void balance(const std::int32_t* __restrict in, const std::int32_t* __restrict across,
             const std::int32_t* __restrict south, const std::int32_t* __restrict north, int count,
             std::int32_t* __restrict out, std::int32_t* __restrict changed) {
    for (int i = 0; i < count; ++i) {
        const std::int32_t change = across[i] - across[i + 1] + south[i] - north[i];
        out[i] = in[i] + change;
        changed[i] |= change;
    }
}

template <class Scheme, bool kTool>
class Sweep {
public:
    Sweep(const PatchSweep& patch, std::int64_t& outflow)
        : patch_(patch), scheme_(patch), outflow_(outflow), width_(patch.cells.x1 - patch.cells.x0) {}

    void run() {
        std::fill_n(changed_.data(), width_, 0);
        std::array<Fluxes, 2> fluxes;
        std::array<Row<float>, 2> rises;
        Fluxes* south = &fluxes[0];
        Fluxes* north = &fluxes[1];
        Row<float>* rise = &rises[0];
        Row<float>* riseAbove = &rises[1];
        riseEast(patch_.cells.y0 - 1, *rise);
        riseEast(patch_.cells.y0, *riseAbove);
        northFluxes(patch_.cells.y0 - 1, *rise, *riseAbove, *south);
        for (int y = patch_.cells.y0; y < patch_.cells.y1; ++y) {
            std::swap(rise, riseAbove);
            riseEast(y + 1, *riseAbove);
            northFluxes(y, *rise, *riseAbove, *north);
            eastFluxes(y);
            balance(rowOf(y), across_.data(), south->data(), north->data(), width_,
                    patch_.out + y * patch_.stride + patch_.cells.x0, changed_.data());
            std::swap(south, north);
            const int done = y + 1 - patch_.cells.y0;
            if (done % patch_.blockSize == 0 || y + 1 == patch_.cells.y1) {
                reportMoved((done - 1) / patch_.blockSize);
            }
        }
    }

private:
    /// The patch's first cell in row y.
    [[nodiscard]] const std::int32_t* rowOf(int y) const { return patch_.in + y * patch_.stride + patch_.cells.x0; }
    [[nodiscard]] const std::int32_t* roomOf(int y) const {
        return patch_.room + (y - patch_.cells.y0 + 1) * (width_ + 2) + 1;
    }
    /// Over an open rim sand falls to height 0 and never comes back.
    [[nodiscard]] std::int32_t overRim(std::int32_t height, std::int32_t along) const {
        return std::max(scheme_(height, 2 * static_cast<float>(along)), 0);
    }

    /// Tells which blocks of a row of blocks have changed, and begins the next.
    void reportMoved(int blockRow) {
        std::uint8_t* moved = patch_.moved + blockRow * patch_.blocksAcross;
        for (int x = 0; x < width_; x += patch_.blockSize) {
            const auto end = changed_.data() + std::min(x + patch_.blockSize, width_);
            *moved++ = std::any_of(changed_.data() + x, end, [](std::int32_t bits) { return bits != 0; }) ? 1 : 0;
        }
        std::fill_n(changed_.data(), width_, 0);
    }

    /// How much higher the eastern neighbour of each cell of row y is than the western one.
    void riseEast(int y, Row<float>& rise) const {
        if constexpr (Scheme::kNeedsAlong) {
            differences(rowOf(y) + 1, rowOf(y) - 1, wholeVectors(width_), rise.data());
        }
    }

    /// Fluxes from row y to row y + 1, one per column of the patch.
    void northFluxes(int y, Row<float>& rise, Row<float>& riseAbove, Fluxes& flux) {
        if (y < 0 || y == patch_.rows - 1) {
            rimNorth(y, flux);
            return;
        }
        fluxesBetween(scheme_, rowOf(y), rowOf(y + 1), rise.data(), riseAbove.data(), wholeVectors(width_),
                      flux.data());
        if constexpr (kTool) {
            limit(roomOf(y), roomOf(y + 1), width_, flux.data());
        }
    }

    void rimNorth(int y, Fluxes& flux) {
        std::fill_n(flux.data(), width_, 0);
        if (!patch_.openRim) {
            return;
        }
        const std::int32_t* inner = rowOf(std::max(y, 0));
        for (int i = 0; i < width_; ++i) {
            const std::int32_t q = overRim(inner[i], inner[i + 1] - inner[i - 1]);
            flux[i] += y < 0 ? -q : q;
            outflow_ += q;
        }
    }

    /// Fluxes through the vertical faces of row y: index i lies between cells i - 1 and i of the patch.
    void eastFluxes(int y) {
        const std::int32_t* here = rowOf(y);
        const int faces = wholeVectors(width_ + 1);
        if constexpr (Scheme::kNeedsAlong) {  // index i is that of cell i - 1
            differences(rowOf(y + 1) - 1, rowOf(y - 1) - 1, faces + kLanes, riseNorth_.data());
        }
        fluxesBetween(scheme_, here - 1, here, riseNorth_.data(), riseNorth_.data() + 1, faces, across_.data());
        if constexpr (kTool) {
            limit(roomOf(y) - 1, roomOf(y), width_ + 1, across_.data());
        }
        if (patch_.cells.x0 == 0) {
            across_[0] = -rimEast(y, 0);
        }
        if (patch_.cells.x1 == patch_.columns) {
            across_[width_] = rimEast(y, width_ - 1);
        }
    }

    /// What falls over the rim beside cell i of row y.
    std::int32_t rimEast(int y, int i) {
        const std::int32_t q = patch_.openRim ? overRim(rowOf(y)[i], rowOf(y + 1)[i] - rowOf(y - 1)[i]) : 0;
        outflow_ += q;
        return q;
    }

    const PatchSweep& patch_;
    const Scheme scheme_;
    std::int64_t& outflow_;
    const int width_;
    Row<float> riseNorth_;
    Fluxes across_;
    Fluxes changed_;  // per column: every bit that changed
};

}  // namespace

void sweepPatch(const PatchSweep& patch, std::int64_t& outflow) {
    if (patch.n4) {
        patch.room != nullptr ? Sweep<FourNeighbours, true>(patch, outflow).run()
                              : Sweep<FourNeighbours, false>(patch, outflow).run();
    } else {
        patch.room != nullptr ? Sweep<Isotropic, true>(patch, outflow).run()
                              : Sweep<Isotropic, false>(patch, outflow).run();
    }
}

}  // namespace sand::SANDWALL_CODE_PATH
