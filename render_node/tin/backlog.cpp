// SPDX-License-Identifier: Apache-2.0
#include "render_node/tin/backlog.hpp"

#include <algorithm>

namespace render_node {

void TinBacklog::add(const sand::TinChange& change, const shapes::Box& box) {
    triangles_.add(change.triangles);
    vertices_.add(change.vertices);
    if (boxes_.size() < kMostBoxes) {
        boxes_.push_back(box);
    } else {
        boxes_.back() = around(boxes_.back(), box);
    }
}

bool TinBacklog::isSeen(std::span<const glm::dmat4> cameras) const {
    return std::ranges::any_of(boxes_, [cameras](const shapes::Box& box) {
        return cameras.empty() || std::ranges::any_of(cameras, [&box](const glm::dmat4& sceneToClip) {
                   return shapes::inFrustum(box, sceneToClip);
               });
    });
}

sand::TinChange TinBacklog::take() {
    sand::TinChange all{.triangles = triangles_.all(), .vertices = vertices_.all()};
    std::sort(all.triangles.begin(), all.triangles.end());
    std::sort(all.vertices.begin(), all.vertices.end());
    clear();
    return all;
}

void TinBacklog::clear() {
    triangles_.clear();
    vertices_.clear();
    boxes_.clear();
}

}  // namespace render_node
