// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/undo.hpp"

#include <algorithm>
#include <utility>

namespace sand::tin {

void Undo::replaced(const VertexSand& layer) {
    copy_ = copy();
    parts_ = layer.parts();
    parts_.constraints = {};
    constraints_.clear();
    vertices_.clear();
    slots_.clear();
    for (std::size_t slot = 0; slot < layer.triangles().triangles.size(); ++slot) {
        followTriangle(layer, static_cast<std::int32_t>(slot));
    }
}

void Undo::followVertex(const VertexSand& layer, Vertex vertex) {
    const auto at = static_cast<std::size_t>(vertex);
    if (at >= parts_.places.size()) {
        const std::size_t count = layer.triangles().places.size();
        parts_.places.resize(count, VertexSandParts::kNowhere);
        parts_.volumes.resize(count, 0);
        parts_.moving.resize(count, 0);
    }
    parts_.places[at] = layer.triangles().alive(vertex) ? layer.triangles().places[at] : VertexSandParts::kNowhere;
    parts_.volumes[at] = layer.volumes()[at];
    parts_.moving[at] = layer.moving()[at];
}

/// A constraint belongs to the triangle in which it runs from its smaller vertex to the larger.
void Undo::followTriangle(const VertexSand& layer, std::int32_t slot) {
    const Triangle& triangle = layer.triangles().triangles[static_cast<std::size_t>(slot)];
    std::vector<std::pair<Vertex, Vertex>> owned;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vertex a = triangle.corner[(k + 1) % 3], b = triangle.corner[(k + 2) % 3];
        if (triangle.constrained[k] && triangle.neighbour[k] != kNoNumber && a < b) {
            owned.emplace_back(a, b);
        }
    }
    if (owned.empty()) {
        constraints_.erase(slot);
    } else {
        constraints_[slot] = std::move(owned);
    }
}

void Undo::keep(const VertexSand& layer, const TinState& state) {
    for (const Vertex vertex : vertices_.all()) {
        followVertex(layer, vertex);
    }
    for (const std::int32_t slot : slots_.all()) {
        followTriangle(layer, slot);
    }
    vertices_.clear();
    slots_.clear();
    state_ = state;
    copy_ = nullptr;
    any_ = true;
}

void Undo::keep(std::shared_ptr<const Snapshot> copy) {
    copy_ = std::move(copy);
    any_ = true;
}

void Undo::forget() {
    copy_ = nullptr;
    any_ = false;
}

std::shared_ptr<const Snapshot> Undo::copy() const {
    if (any_ && copy_ == nullptr) {
        VertexSandParts whole = parts_;
        for (const auto& [slot, owned] : constraints_) {
            whole.constraints.insert(whole.constraints.end(), owned.begin(), owned.end());
        }
        std::sort(whole.constraints.begin(), whole.constraints.end());
        copy_ = std::make_shared<const Snapshot>(whole, state_);
    }
    return copy_;
}

}  // namespace sand::tin
