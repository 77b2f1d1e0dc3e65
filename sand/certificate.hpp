// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sand/height_field.hpp"
#include "sand/net_flux.hpp"
#include "sand/scene.hpp"

namespace sand {

/// How far a field at rest can at most be from the right one.
///
/// "Right" is the projection of the start onto the fields in which no quad is steeper than the steepest one here, a
/// quad being the square between four cell centres and its slope the root of half the sum of its four squared
/// differences. The bound is computed from the fluxes alone and needs no knowledge of that projection.
struct Certificate {
    double squaredDistance = 0;  // [unit²], summed over the cells: at least the squared distance to the projection
    double gap = 0;  // [unit²], the bound for quads at the threshold: holds, and is positive, if none is steeper
    double squaredMoved = 0;  // [unit²], summed over the cells: squared distance from start to rest
    double steepest = 0;      // [unit], slope of the steepest quad at rest; the threshold, or a few per cent more

    /// The bound as a share of what was moved.
    [[nodiscard]] double relative() const { return squaredMoved > 0 ? squaredDistance / squaredMoved : 0; }
    /// The gap as a share of what was moved: shrinks with the cell size where the rest state is the right one. The
    /// bound itself does not where sweeps leave a few quads at a kink some per cent too steep, for it must allow that
    /// slope everywhere.
    [[nodiscard]] double relativeGap() const { return squaredMoved > 0 ? gap / squaredMoved : 0; }
};

/// The certificate of a relaxation from `start` to `rest` whose faces let `flux` pass: the start less its divergence
/// must be the rest, which an assertion in the tests checks and this does not. Heights at an open rim must not lie
/// below 0. Sums are taken in a fixed order.
///
/// Why it holds: with S(w) the sum over quads of |V|·steepest·√2 - V·Dw, where V are half the fluxes of the quad's four
/// faces and D the differences across them, S(w) ≥ 0 for every stable w. Hence (start - rest)·(w - rest) ≤ S(rest);
/// with w the projection p, for which (start - p)·(rest - p) ≤ 0, the sum is |p - rest|² ≤ S(rest).
[[nodiscard]] Certificate certify(const HeightField& start, const HeightField& rest, const NetFlux& flux,
                                  const Rules& rules);

}  // namespace sand
