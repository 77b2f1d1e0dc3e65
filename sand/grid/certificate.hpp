// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sand/grid/net_flux.hpp"
#include "sand/model/height_field.hpp"
#include "sand/model/rules.hpp"

namespace sand::grid {

/// How far a field at rest can at most be from the right one.
///
/// "Right" is the projection of the start onto the fields in which no quad is steeper than the threshold, a quad being
/// the square between four cell centres and its slope the root of half the sum of its four squared differences. The
/// bound is computed from the fluxes alone and needs no knowledge of that projection.
struct Certificate {
    double squaredDistance = 0;  // [unit²], summed over the cells: at least the squared distance to the projection
    double squaredMoved = 0;     // [unit²], summed over the cells: squared distance from start to rest

    /// The bound as a share of what was moved: shrinks with the cell size where the rest state is the right one.
    [[nodiscard]] double relative() const { return squaredMoved > 0 ? squaredDistance / squaredMoved : 0; }
};

/// The certificate of a relaxation from `start` to `rest` whose faces let `flux` pass: the start less its divergence
/// must be the rest, which an assertion in the tests checks and this does not. Heights at an open rim must not lie
/// below 0. Sums are taken in a fixed order.
///
/// Why it holds: let S(w) be the sum over quads of threshold·√2·|V| - V·Dw, where V are half the fluxes through the
/// quad's four faces and Dw the falls of w across them. S(w) ≥ 0 where no quad of w is too steep, and (start - rest)·(w
/// - v) = S(v) - S(w), since the start less the divergence is the rest. The projection p satisfies (start - p)·(w - p)
/// ≤ 0 for every such w. The rest may be a little too steep; let w be a field near it that is not
/// (QuadEnergy::flatten). Then with x = |p - rest| and e = |w - rest|
///     x² = (start - p)·(rest - p) + (start - rest)·(p - rest)
///        ≤ (start - p)·(rest - w) + S(rest) - S(p)
///        ≤ (start - rest)·(rest - w) + x·e + S(rest) = S(w) + x·e,
/// and hence x ≤ (e + √(e² + 4 S(w))) / 2.
[[nodiscard]] Certificate certify(const HeightField& start, const HeightField& rest, const NetFlux& flux,
                                  const Rules& rules);

}  // namespace sand::grid
