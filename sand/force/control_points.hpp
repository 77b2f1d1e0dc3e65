// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sand/force/force_constants.hpp"
#include "sand/force/gauges.hpp"
#include "sand/force/response.hpp"
#include "sand/force/surface_patch.hpp"

/// The law of Purchart et al. 2012. Lengths are in units of ForceConstants::unitLength, because the paper normalises
/// them.
///
/// Equations 2, 4, 5 and 6 are reconstructed, because only their prose is left:
///   (3) dh_i = z_ci − z_tool, how far the sand at control point i stands over the tool there   [as printed]
///   (4) dir_i = (c_i − P) / |c_i − P|, horizontal                                              [reconstructed]
///   (5) F_ri = −dh_i dir_i F_M: sand that is higher on one side pushes to the other            [reconstructed]
///   (6) F_pi = (0, 0, dh_i) F_M                                                                [reconstructed]
///   (2) F = (1/N) Σ (F_ri + F_pi) + F_G                                                        [reconstructed]
///   (7, 8) F_G = (v_x, v_y, 0) F_M, v = P_old − P_act per frame: the gel effect                [as printed]
///   (1) F_s = −mu F_n (v_x, v_y, 0)/v_mu, with F_n = (1/N) Σ |F_pi|                            [an option]
///
/// The text also lets friction grow with the speed, and with a coefficient mu of the material, but gives no formula.
/// F_s is this project's choice: Coulomb's friction mu F_n at the speed v_mu, proportional to the speed below and
/// above.
///
/// A control point acts from dh_i > −z_tol on. Taken literally, this pulls the tool down over the sand, and the force
/// jumps by z_tol F_M. `literal` keeps that. Otherwise a control point acts from dh_i > 0 on, and its effect reaches
/// dh_i at z_tol.
namespace sand::force {

/// Returns dh_i for every control point of the tool at `place`. A control point beside the field does not touch the
/// sand.
[[nodiscard]] Gauges measureControlPoints(const ForceConstants& constants, const SurfacePatch& patch,
                                          const Contour& tool, Vec3 place /* [scene unit] */);

[[nodiscard]] Response controlPointsForce(const ForceConstants& constants, const Contour& tool, const Gauges& gauges);

}  // namespace sand::force
