// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "sand/force/contour.hpp"
#include "sand/force/dual.hpp"

namespace sand::force {

/// All numbers that a law reads from the sand at a place, each with its gradient over the place. A law depends only on
/// these numbers and the tool. The local model continues these numbers along their gradients.
struct Gauges {
    static constexpr std::size_t kMost = Contour::kPoints;
    std::size_t count = 0;
    std::array<Dual, kMost> dials;
};

}  // namespace sand::force
