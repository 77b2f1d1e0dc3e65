// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "render_node/surface/frustum.hpp"

namespace render_node {

/// Many small boxes, spread over a field, as few that bound them: those that lie near each other become one.
class BoxBins {
public:
    BoxBins(double width, double depth /* of the field [scene unit] */);
    void add(const Box& box);
    /// Around all that were added since this was called last.
    [[nodiscard]] std::vector<Box> take();

private:
    static constexpr int kSide = 32;               // [bin]
    static constexpr std::size_t kMostBoxes = 36;  // that take() gives
    double acrossWidth_, acrossDepth_;             // bins in a scene unit
    std::vector<std::optional<Box>> bins_;
    std::vector<int> used_;
};

}  // namespace render_node
