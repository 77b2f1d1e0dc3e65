// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "sand/grid/erosion.hpp"
#include "sand/model/surface.hpp"
#include "sand/start.hpp"

namespace sand {

/// Returns the sand that a replica begins with. `options` choose how a height field is swept; they never change the
/// result. The ground of `start` replaces `options.ground`.
[[nodiscard]] std::unique_ptr<Surface> makeSurface(const Start& start, const grid::Erosion::Options& options = {});

/// Makes `start` begin with the current sand of `surface`, which makeSurface() made from `start`.
void startFrom(const Surface& surface, Start& start);

}  // namespace sand
