// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "shapes/model/box.hpp"

namespace render_node {

/// Collection of many small boxes in a field. It joins boxes that are close together, so that few boxes bound all of
/// them.
class BoxBins {
public:
    BoxBins(double width, double depth /* of the field [scene unit] */);
    void add(const shapes::Box& box);
    /// Returns boxes around all boxes that were added since the last call.
    [[nodiscard]] std::vector<shapes::Box> take();

private:
    static constexpr int kSide = 32;               // [bin]
    static constexpr std::size_t kMostBoxes = 36;  // largest number of boxes that take() returns
    double acrossWidth_, acrossDepth_;             // bins per scene unit
    std::vector<std::optional<shapes::Box>> bins_;
    std::vector<int> used_;
};

}  // namespace render_node
