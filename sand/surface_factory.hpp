// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "base/executor.hpp"
#include "sand/model/mean_height.hpp"
#include "sand/model/surface.hpp"
#include "sand/start.hpp"

namespace sand {

/// Returns the sand that a replica begins with. `executor` shares out the work of a height field's sweeps, and must
/// outlive the sand. If it is null, the calling thread does all work. If the heights of `start` are taken, it unpacks
/// them.
[[nodiscard]] std::unique_ptr<Surface> makeSurface(const Start& start, const base::Executor* executor = nullptr);

/// Returns the same, and takes the heights of `start` (Start::takeHeights()) in place of a copy.
[[nodiscard]] std::unique_ptr<Surface> makeSurfaceOfTaken(Start& start, const base::Executor* executor = nullptr);

/// Returns the exact volume of the sand that `start` begins with, in the unit of Replica::volume(). Triangulates a TIN.
[[nodiscard]] std::int64_t volumeOf(const Start& start);

/// Time at which startHeights() unpacks a height field. At the first use, it takes no further memory until then, if
/// Start::packed is set; a single thread may call the function.
enum class Heights : bool { now, atFirstUse };
/// Returns the height of the sand that `start` begins with, at each place. It is continuous: a height field is
/// interpolated between its cells. Outside the field, it is the height of the nearest place in it. The function keeps
/// these heights, also after Start::dropHeights().
[[nodiscard]] HeightAt startHeights(const Start& start, Heights when = Heights::now);

/// Makes `start` begin with the current sand of `surface`, which makeSurface() made from `start`.
void startFrom(const Surface& surface, Start& start);

}  // namespace sand
