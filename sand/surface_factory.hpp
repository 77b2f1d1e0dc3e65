// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "sand/grid/erosion.hpp"
#include "sand/model/surface.hpp"
#include "sand/start.hpp"

namespace sand {

/// The sand that a replica starts with. `options` say how the sand of a height field is swept, not what comes of it;
/// their ground is that of `start`.
[[nodiscard]] std::unique_ptr<Surface> makeSurface(const Start& start, const grid::Erosion::Options& options = {});

/// Has `start` begin with the sand as it is on `surface`, which was made from it.
void startFrom(const Surface& surface, Start& start);

}  // namespace sand
