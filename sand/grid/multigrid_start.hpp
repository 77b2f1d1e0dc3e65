// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include "sand/grid/dual_projection.hpp"

namespace sand::grid {

/// Makes a projection of `field` start near its end. It projects the mean heights of 2 × 2 cells, which starts in the
/// same way, down to a few cells. It hands on the pressures of that projection. These miss mostly local detail, which
/// iterations on the fine cells find quickly.
///
/// A field has one projection, whatever the iterations start from. This function changes only how soon they come near
/// it. It changes neither the projection nor the accuracy. Call it before projection.run(), with the arguments from
/// which the projection was made. While it runs, the coarser projections take a third as much memory as `projection`.
void startFromCoarser(DualProjection& projection, const HeightField& field, const Rules& rules,
                      base::CodePath path = base::fastestCodePath(), WorkLimit* limit = nullptr);

}  // namespace sand::grid
