// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sand/grid/net_flux.hpp"
#include "sand/model/height_field.hpp"
#include "sand/model/rules.hpp"

namespace sand::grid {

/// Upper bound of the distance between a field at rest and the right field.
///
/// The right field is the projection of the start onto the fields in which no quad is steeper than the threshold. A
/// quad is the square between four cell centres. Its slope is the square root of half the sum of its four squared
/// differences. The bound is computed from the fluxes alone, without that projection.
struct Certificate {
    double squaredDistance = 0;  // upper bound of the squared distance to the projection, summed over the cells [unit²]
    double squaredMoved = 0;     // squared distance from start to rest, summed over the cells [unit²]

    /// Returns the bound as a share of the squared distance moved; 0 if no sand moved. It shrinks with the cell size if
    /// the field at rest is the right one.
    [[nodiscard]] double relative() const { return squaredMoved > 0 ? squaredDistance / squaredMoved : 0; }
};

/// Returns the certificate of a relaxation from `start` to `rest`, in which `flux` passed the faces. `rest` must be
/// `start` minus the divergence of `flux`. This function does not check that; an assertion in the tests does. Heights
/// at an open rim must not be below 0. Sums are taken in a fixed order.
///
/// Proof: let S(w) be the sum over quads of threshold·√2·|V| - V·Dw. Here V are half the fluxes through the quad's four
/// faces, and Dw are the falls of w across them. S(w) ≥ 0 if no quad of w is too steep. Moreover, (start - rest)·(w -
/// v) = S(v) - S(w), because the rest is the start minus the divergence. The projection p satisfies (start - p)·(w - p)
/// ≤ 0 for every such w. The field at rest may be a little too steep. Let w be a field near it that is not too steep
/// (QuadEnergy::flatten). Then, with x = |p - rest| and e = |w - rest|,
///     x² = (start - p)·(rest - p) + (start - rest)·(p - rest)
///        ≤ (start - p)·(rest - w) + S(rest) - S(p)
///        ≤ (start - rest)·(rest - w) + x·e + S(rest) = S(w) + x·e,
/// and therefore x ≤ (e + √(e² + 4 S(w))) / 2.
[[nodiscard]] Certificate certify(const HeightField& start, const HeightField& rest, const NetFlux& flux,
                                  const Rules& rules);

}  // namespace sand::grid
