// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "base/index_set.hpp"
#include "render_node/surface/frustum.hpp"
#include "sand/model/surface_data.hpp"
#include "sand/tin/geometry/surface_view.hpp"

namespace render_node {

/// Damage of a TIN that no camera has seen yet: most tiles of a wall never look where sand is dug, and to light a TIN
/// anew takes as long as to draw it. Not thread-safe.
class TinBacklog {
public:
    /// All of it lies within the box.
    void add(const sand::TinChange& damage, const Box& box);
    /// Whether one of these cameras (each from the scene to clip coordinates) sees some of it; without any, whether
    /// there is some.
    [[nodiscard]] bool isSeen(std::span<const glm::dmat4> cameras) const;
    /// Everything that was added since this was called last; holds until then what has long been put right again, too.
    [[nodiscard]] sand::TinChange take();
    void clear();

private:
    static constexpr std::size_t kMostBoxes = 32;

    base::IndexList triangles_, vertices_;
    std::vector<Box> boxes_;
};

}  // namespace render_node
