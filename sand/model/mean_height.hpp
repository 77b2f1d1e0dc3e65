// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace sand {

/// Height of a surface [unit] at a place (x, y) [probe unit].
using HeightAt = std::function<double(double x, double y)>;

/// Returns the mean height under a tool [unit]. Ripples smaller than the tool must not shake the hand.
///
/// The mean is that of `samples` × `samples` places in a square around (x, y), whose sides are 2 · `radius` long.
/// `samples` is odd and at least 3.
[[nodiscard]] double meanHeight(const HeightAt& heightAt, double x, double y, double radius /* [probe unit] */,
                                int samples);

}  // namespace sand
