// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "sand/force/contour.hpp"
#include "sand/force/dual.hpp"

namespace sand::force {

/// All that a law reads off the sand at a place: a few numbers, each with its gradient over the place. A law is a
/// function of these and of the tool alone; the local model is these numbers, carried on along their gradients.
struct Gauges {
    static constexpr std::size_t kMost = Contour::kPoints;
    std::size_t count = 0;
    std::array<Dual, kMost> dials;
};

}  // namespace sand::force
