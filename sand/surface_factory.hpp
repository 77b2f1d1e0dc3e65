// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "sand/grid/erosion.hpp"
#include "sand/model/mean_height.hpp"
#include "sand/model/surface.hpp"
#include "sand/start.hpp"

namespace sand {

/// Returns the sand that a replica begins with. `options` choose how a height field is swept; they never change the
/// result. The ground of `start` replaces `options.ground`.
[[nodiscard]] std::unique_ptr<Surface> makeSurface(const Start& start, const grid::Erosion::Options& options = {});

/// Returns the height of the sand that `start` begins with, at each place. It is continuous: a height field is
/// interpolated between its cells. Outside the field, it is the height of the nearest place in it. `start` must outlive
/// the function.
[[nodiscard]] HeightAt startHeights(const Start& start);

/// Makes `start` begin with the current sand of `surface`, which makeSurface() made from `start`.
void startFrom(const Surface& surface, Start& start);

}  // namespace sand
