// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <span>

#include "sand/tin/geometry/triangles.hpp"

namespace sand::tin {

/// Indices of places, for whoever inserts many at once.
struct SpatialOrder {
    /// In an order in which a mesh takes them quickly: every next is near the one before, after a coarse sample of all
    /// of them, so that no triangle is long for long (Amenta, Choi and Rote 2003). One index for each place.
    std::vector<std::uint32_t> order;
    /// By index: the first index of the same place.
    std::vector<std::uint32_t> first;
};
[[nodiscard]] SpatialOrder spatialOrder(std::span<const Place> places);

}  // namespace sand::tin
