// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <span>

#include "sand/tin/geometry/triangles.hpp"

namespace sand::tin {

/// An order of places for inserting many vertices at once.
struct SpatialOrder {
    /// One index for each place, in an order in which a mesh inserts them fast. A coarse sample of all places comes
    /// first. After that, each place is near the one before, so that no triangle stays long (Amenta, Choi and Rote
    /// 2003).
    std::vector<std::uint32_t> order;
    /// By index: the first index of an equal place.
    std::vector<std::uint32_t> first;
};
/// Returns the order for `places`, which may contain equal places.
[[nodiscard]] SpatialOrder spatialOrder(std::span<const LatticePoint> places);

}  // namespace sand::tin
