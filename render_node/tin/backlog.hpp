// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "base/index_set.hpp"
#include "sand/model/surface_data.hpp"
#include "sand/tin/geometry/surface_view.hpp"
#include "shapes/model/box.hpp"

namespace render_node {

/// Changes of a TIN that no camera has seen yet.
///
/// Most tiles of a wall never show the place where sand is dug, and lighting a TIN takes as long as drawing it. Not
/// thread-safe.
class TinBacklog {
public:
    /// Adds changes that lie within `box`.
    void add(const sand::TinChange& change, const shapes::Box& box);
    /// Returns whether a camera sees some of the changes. `cameras` are matrices from the scene to clip coordinates. If
    /// the list is empty, returns whether there is any change.
    [[nodiscard]] bool isSeen(std::span<const glm::dmat4> cameras) const;
    /// Returns all changes since the last call and removes them. They include triangles and vertices that have since
    /// returned to their drawn state.
    [[nodiscard]] sand::TinChange take();
    void clear();

private:
    static constexpr std::size_t kMostBoxes = 32;

    base::IndexList triangles_, vertices_;
    std::vector<shapes::Box> boxes_;
};

}  // namespace render_node
