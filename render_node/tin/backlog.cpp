// SPDX-License-Identifier: Apache-2.0
#include "render_node/tin/backlog.hpp"

#include <algorithm>

namespace render_node {

void TinBacklog::add(const sand::TinChange& damage, const Box& box) {
    triangles_.add(damage.triangles);
    vertices_.add(damage.vertices);
    if (boxes_.size() < kMostBoxes) {
        boxes_.push_back(box);
    } else {
        boxes_.back() = around(boxes_.back(), box);
    }
}

bool TinBacklog::isSeen(const std::function<bool(const Box&)>& sees) const {
    return std::any_of(boxes_.begin(), boxes_.end(), sees);
}

sand::TinChange TinBacklog::take() {
    sand::TinChange all{.whole = false, .triangles = triangles_.all(), .vertices = vertices_.all()};
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
