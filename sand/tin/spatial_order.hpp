// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "sand/tin/triangles.hpp"

namespace sand::tin {

/// Indices of the places in an order in which a mesh takes them quickly: every next is near the one before, after a
/// coarse sample of all of them, so that no triangle is long for long (Amenta, Choi and Rote 2003).
[[nodiscard]] std::vector<std::uint32_t> spatialOrder(std::span<const Place> places);

}  // namespace sand::tin
