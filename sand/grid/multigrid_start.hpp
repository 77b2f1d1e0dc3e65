// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include "sand/grid/dual_projection.hpp"

namespace sand::grid {

/// Lets a projection of `field` start near its end: projects the mean heights of two by two cells, which starts in the
/// same way, down to a few cells, and hands on those pressures. What they miss is mostly local, and that is what the
/// iterations on the fine cells are quick at.
///
/// A field has one projection, whatever the iteration starts from: this changes how soon it is near, and neither what
/// it is nor how near is near enough. Call it before projection.run(), with the arguments the projection was made from.
/// While it runs, the coarser projections take a third as much memory as the one they serve.
void startFromCoarser(DualProjection& projection, const HeightField& field, const Rules& rules,
                      CodePath path = CodePath::automatic);

}  // namespace sand::grid
