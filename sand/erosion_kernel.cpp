// SPDX-License-Identifier: Apache-2.0
// Compiled once for every x86-64 and once for x86-64-v3, with -O3: g++ 12 does not vectorise these loops at -O2.
#include "sand/erosion_kernel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace sand::SANDWALL_CODE_PATH {
namespace {

using Fluxes = std::array<std::int32_t, kMaxStrip + 1>;  // [unit] through consecutive faces, towards east or north

/// Scheme G of NUMERICS: isotropic, the default. Slope across the face from its two cells, slope along it as the mean
/// of the four differences beside it; `alongA` and `alongB` are the sums of the two differences of either cell.
struct Isotropic {
    // 0.2499 and not 0.25: the float product must not round above the proven bound.
    static constexpr float kShare = 0.2499F;
    float threshold, startThreshold;

    explicit Isotropic(const StripSweep& strip)
        : threshold(static_cast<float>(strip.threshold)), startThreshold(static_cast<float>(strip.startThreshold)) {}

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

    explicit FourNeighbours(const StripSweep& strip)
        : threshold(strip.threshold), startThreshold(strip.startThreshold) {}

    std::int32_t operator()(std::int32_t a, std::int32_t b, std::int32_t, std::int32_t) const {
        const std::int32_t difference = a - b;
        const std::int32_t size = difference < 0 ? -difference : difference;
        const std::int32_t flux = size > startThreshold ? (size - threshold + 3) / 4 : 0;
        return difference < 0 ? -flux : flux;
    }
};

/// `count` fluxes between the cells of two parallel runs; the neighbours of either run lie `along` cells further.
/// A free function on restricted pointers and a copy of the scheme: with members in reach g++ keeps the loop scalar.
template <class Scheme>
void fluxesBetween(const Scheme scheme, const std::int32_t* __restrict a, const std::int32_t* __restrict b,
                   std::ptrdiff_t along, int count, std::int32_t* __restrict flux) {
    for (int i = 0; i < count; ++i) {
        flux[i] = scheme(a[i], b[i], a[i + along] - a[i - along], b[i + along] - b[i - along]);
    }
}

/// Takes a row's fluxes from its cells; returns the bits that changed anywhere.
std::int32_t balance(const std::int32_t* __restrict in, const std::int32_t* __restrict across,
                     const std::int32_t* __restrict south, const std::int32_t* __restrict north, int count,
                     std::int32_t* __restrict out) {
    std::int32_t changed = 0;
    for (int i = 0; i < count; ++i) {
        const std::int32_t change = across[i] - across[i + 1] + south[i] - north[i];
        out[i] = in[i] + change;
        changed |= change;
    }
    return changed;
}

template <class Scheme, bool kTool>
class Sweep {
public:
    Sweep(const StripSweep& strip, std::int64_t& outflow)
        : strip_(strip), scheme_(strip), outflow_(outflow), width_(strip.cells.x1 - strip.cells.x0) {}

    void run() {
        Fluxes south;
        Fluxes north;
        Fluxes across;
        northFluxes(strip_.cells.y0 - 1, south);
        for (int y = strip_.cells.y0; y < strip_.cells.y1; ++y) {
            northFluxes(y, north);
            eastFluxes(y, across);
            std::int32_t* out = strip_.out + y * strip_.stride + strip_.cells.x0;
            for (int block = 0, x = 0; x < width_; ++block, x += strip_.blockSize) {
                const int count = std::min(strip_.blockSize, width_ - x);
                const std::int32_t changed =
                    balance(rowOf(y) + x, across.data() + x, south.data() + x, north.data() + x, count, out + x);
                strip_.moved[block] |= changed != 0 ? 1 : 0;
            }
            std::swap(south, north);
        }
    }

private:
    /// The strip's first cell in row y.
    [[nodiscard]] const std::int32_t* rowOf(int y) const { return strip_.in + y * strip_.stride + strip_.cells.x0; }
    [[nodiscard]] const std::int32_t* roomOf(int y) const {
        return strip_.room + (y - strip_.cells.y0 + 1) * (width_ + 2) + 1;
    }
    static std::int32_t limit(std::int32_t flux, std::int32_t roomBehind, std::int32_t roomAhead) {
        return std::max(std::min(flux, roomAhead), -roomBehind);
    }
    /// Over an open rim sand falls to height 0 and never comes back.
    [[nodiscard]] std::int32_t overRim(std::int32_t height, std::int32_t along) const {
        return std::max(scheme_(height, 0, along, along), 0);
    }

    /// Fluxes from row y to row y + 1, one per column of the strip.
    void northFluxes(int y, Fluxes& flux) {
        if (y < 0 || y == strip_.rows - 1) {
            rimNorth(y, flux);
            return;
        }
        fluxesBetween(scheme_, rowOf(y), rowOf(y) + strip_.stride, 1, width_, flux.data());
        if constexpr (kTool) {
            for (int i = 0; i < width_; ++i) {
                std::int32_t& q = flux[static_cast<std::size_t>(i)];
                q = limit(q, roomOf(y)[i], roomOf(y + 1)[i]);
            }
        }
    }

    void rimNorth(int y, Fluxes& flux) {
        flux.fill(0);
        if (!strip_.openRim) {
            return;
        }
        const std::int32_t* inner = rowOf(std::max(y, 0));
        for (int i = 0; i < width_; ++i) {
            const std::int32_t q = overRim(inner[i], inner[i + 1] - inner[i - 1]);
            flux[static_cast<std::size_t>(i)] += y < 0 ? -q : q;
            outflow_ += q;
        }
    }

    /// Fluxes through the vertical faces of row y: index i lies between cells i - 1 and i of the strip.
    void eastFluxes(int y, Fluxes& flux) {
        const std::int32_t* here = rowOf(y);
        const std::int32_t* above = here + strip_.stride;
        const std::int32_t* below = here - strip_.stride;
        const bool westRim = strip_.cells.x0 == 0;
        const bool eastRim = strip_.cells.x1 == strip_.columns;
        const int first = westRim ? 1 : 0;
        const int end = width_ + (eastRim ? 0 : 1);
        if (!westRim) {  // by itself, so that the others come in whole vectors
            fluxesBetween(scheme_, here - 1, here, strip_.stride, 1, flux.data());
        }
        fluxesBetween(scheme_, here, here + 1, strip_.stride, end - 1, flux.data() + 1);
        if constexpr (kTool) {
            for (int i = first; i < end; ++i) {
                std::int32_t& q = flux[static_cast<std::size_t>(i)];
                q = limit(q, roomOf(y)[i - 1], roomOf(y)[i]);
            }
        }
        if (westRim) {
            const std::int32_t q = strip_.openRim ? overRim(here[0], above[0] - below[0]) : 0;
            flux[0] = -q;
            outflow_ += q;
        }
        if (eastRim) {
            const int last = width_ - 1;
            const std::int32_t q = strip_.openRim ? overRim(here[last], above[last] - below[last]) : 0;
            flux[static_cast<std::size_t>(width_)] = q;
            outflow_ += q;
        }
    }

    const StripSweep& strip_;
    const Scheme scheme_;
    std::int64_t& outflow_;
    const int width_;
};

}  // namespace

void sweepStrip(const StripSweep& strip, std::int64_t& outflow) {
    if (strip.n4) {
        strip.room != nullptr ? Sweep<FourNeighbours, true>(strip, outflow).run()
                              : Sweep<FourNeighbours, false>(strip, outflow).run();
    } else {
        strip.room != nullptr ? Sweep<Isotropic, true>(strip, outflow).run()
                              : Sweep<Isotropic, false>(strip, outflow).run();
    }
}

}  // namespace sand::SANDWALL_CODE_PATH
