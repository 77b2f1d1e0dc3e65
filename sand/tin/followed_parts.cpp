// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/followed_parts.hpp"

#include <algorithm>
#include <iterator>

namespace sand::tin {
namespace {

using Was = EarlierParts::Was;
using WasEdge = EarlierParts::WasEdge;

bool isBefore(const Was& a, const Was& b) { return a.vertex < b.vertex; }
bool edgeIsBefore(const WasEdge& a, const WasEdge& b) { return a.edge < b.edge; }

bool isSame(const Was& a, const Was& b) {
    const bool gone = a.place == VertexSandParts::kNowhere && b.place == VertexSandParts::kNowhere;
    return gone || (a.place == b.place && a.volume == b.volume && a.moving == b.moving);
}

/// Merges two ascending lists. Takes the element of `first` if both have one.
template <class Element, class Before>
std::vector<Element> merged(const std::vector<Element>& first, const std::vector<Element>& more, Before before) {
    std::vector<Element> all;
    all.reserve(first.size() + more.size());
    std::set_union(first.begin(), first.end(), more.begin(), more.end(), std::back_inserter(all), before);
    return all;
}

}  // namespace

void EarlierParts::addMissing(const EarlierParts& later) {
    if (!later.vertices.empty()) {
        vertices = merged(vertices, later.vertices, isBefore);
    }
    if (!later.constraints.empty()) {
        constraints = merged(constraints, later.constraints, edgeIsBefore);
    }
}

void EarlierParts::putInto(VertexSandParts& parts) const {
    for (const Was& was : vertices) {
        const auto at = static_cast<std::size_t>(was.vertex);
        if (at >= parts.places.size()) {
            parts.places.resize(at + 1, VertexSandParts::kNowhere);
            parts.volumes.resize(at + 1, 0);
            parts.moving.resize(at + 1, 0);
        }
        parts.places[at] = was.place;
        parts.volumes[at] = was.volume;
        parts.moving[at] = was.moving;
    }
    std::vector<Edge> with, without;
    for (const WasEdge& was : constraints) {
        (was.there ? with : without).push_back(was.edge);
    }
    std::vector<Edge> kept, all;
    std::set_difference(parts.constraints.begin(), parts.constraints.end(), without.begin(), without.end(),
                        std::back_inserter(kept));
    std::set_union(kept.begin(), kept.end(), with.begin(), with.end(), std::back_inserter(all));
    parts.constraints = std::move(all);
}

std::int64_t EarlierParts::bytes() const {
    return static_cast<std::int64_t>(vertices.capacity() * sizeof(Was) + constraints.capacity() * sizeof(WasEdge));
}

void FollowedParts::reserve(std::size_t vertices) {
    parts_.places.reserve(vertices);
    parts_.volumes.reserve(vertices);
    parts_.moving.reserve(vertices);
    vertices_.reserve(vertices);
    slots_.reserve(2 * vertices);
}

void FollowedParts::touchAll(const VertexSand& layer) {
    const auto vertices = static_cast<Vertex>(std::max(parts_.places.size(), layer.triangles().places.size()));
    for (Vertex vertex = 0; vertex < vertices; ++vertex) {
        vertices_.add(vertex);
    }
    const auto owning = constraints_.empty() ? 0 : constraints_.rbegin()->first + 1;
    const auto slots = std::max(owning, static_cast<std::int32_t>(layer.triangles().triangles.size()));
    for (std::int32_t slot = 0; slot < slots; ++slot) {
        slots_.add(slot);
    }
}

void FollowedParts::replaced(const VertexSand& layer) {
    parts_ = layer.parts();
    parts_.constraints = {};
    constraints_.clear();
    vertices_.clear();
    slots_.clear();
    for (std::size_t slot = 0; slot < layer.triangles().triangles.size(); ++slot) {
        followTriangle(layer, static_cast<std::int32_t>(slot));
    }
}

void FollowedParts::followVertex(const VertexSand& layer, Vertex vertex) {
    const auto at = static_cast<std::size_t>(vertex);
    const std::size_t count = layer.triangles().places.size();
    if (at >= parts_.places.size()) {
        parts_.places.resize(count, VertexSandParts::kNowhere);
        parts_.volumes.resize(count, 0);
        parts_.moving.resize(count, 0);
    }
    const bool there = at < count;  // false after other sand with fewer vertices has taken its place
    parts_.places[at] =
        there && layer.triangles().alive(vertex) ? layer.triangles().places[at] : VertexSandParts::kNowhere;
    parts_.volumes[at] = there ? layer.volumes()[at] : 0;
    parts_.moving[at] = there ? layer.moving()[at] : std::uint8_t{0};
}

/// A constraint belongs to the triangle in which it runs from its smaller vertex to the larger.
void FollowedParts::followTriangle(const VertexSand& layer, std::int32_t slot) {
    std::vector<EarlierParts::Edge> owned;
    if (static_cast<std::size_t>(slot) < layer.triangles().triangles.size()) {
        const Triangle& triangle = layer.triangles().triangles[static_cast<std::size_t>(slot)];
        for (std::size_t k = 0; k < 3; ++k) {
            const Vertex a = triangle.corner[(k + 1) % 3], b = triangle.corner[(k + 2) % 3];
            if (triangle.constrained[k] && triangle.neighbour[k] != kNoNumber && a < b) {
                owned.emplace_back(a, b);
            }
        }
    }
    if (owned.empty()) {
        constraints_.erase(slot);
    } else {
        constraints_[slot] = std::move(owned);
    }
}

void FollowedParts::bringUpToDate(const VertexSand& layer) {
    for (const Vertex vertex : vertices_.all()) {
        followVertex(layer, vertex);
    }
    for (const std::int32_t slot : slots_.all()) {
        followTriangle(layer, slot);
    }
    vertices_.clear();
    slots_.clear();
}

Was FollowedParts::vertexAt(Vertex vertex) const {
    const auto at = static_cast<std::size_t>(vertex);
    if (at >= parts_.places.size()) {
        return {.vertex = vertex};
    }
    return {parts_.volumes[at], parts_.places[at], vertex, parts_.moving[at]};
}

/// Returns the constraints of the touched slots, in ascending order.
std::vector<EarlierParts::Edge> FollowedParts::constraintsOfTouched() const {
    std::vector<EarlierParts::Edge> all;
    for (const std::int32_t slot : slots_.all()) {
        if (const auto owned = constraints_.find(slot); owned != constraints_.end()) {
            all.insert(all.end(), owned->second.begin(), owned->second.end());
        }
    }
    std::sort(all.begin(), all.end());
    return all;
}

EarlierParts FollowedParts::takeChanges(const VertexSand& layer) {
    EarlierParts changed;
    for (const Vertex vertex : vertices_.all()) {
        const Was before = vertexAt(vertex);
        followVertex(layer, vertex);
        if (!isSame(before, vertexAt(vertex))) {
            changed.vertices.push_back(before);
        }
    }
    std::sort(changed.vertices.begin(), changed.vertices.end(), isBefore);
    // A constraint that has only changed its slot is in both lists.
    const std::vector<EarlierParts::Edge> before = constraintsOfTouched();
    for (const std::int32_t slot : slots_.all()) {
        followTriangle(layer, slot);
    }
    const std::vector<EarlierParts::Edge> after = constraintsOfTouched();
    std::vector<EarlierParts::Edge> differ;
    std::set_symmetric_difference(before.begin(), before.end(), after.begin(), after.end(), std::back_inserter(differ));
    for (const EarlierParts::Edge& edge : differ) {
        changed.constraints.push_back({edge, std::binary_search(before.begin(), before.end(), edge)});
    }
    vertices_.clear();
    slots_.clear();
    return changed;
}

EarlierParts FollowedParts::presentOf(const EarlierParts& parts) const {
    EarlierParts present;
    present.vertices.reserve(parts.vertices.size());
    for (const Was& was : parts.vertices) {
        present.vertices.push_back(vertexAt(was.vertex));
    }
    if (!parts.constraints.empty()) {
        const std::vector<EarlierParts::Edge> all = constraints();
        for (const WasEdge& was : parts.constraints) {
            present.constraints.push_back({was.edge, std::binary_search(all.begin(), all.end(), was.edge)});
        }
    }
    return present;
}

std::vector<EarlierParts::Edge> FollowedParts::constraints() const {
    std::vector<EarlierParts::Edge> all;
    for (const auto& [slot, owned] : constraints_) {
        all.insert(all.end(), owned.begin(), owned.end());
    }
    std::sort(all.begin(), all.end());
    return all;
}

VertexSandParts FollowedParts::parts() const {
    VertexSandParts whole = parts_;
    whole.constraints = constraints();
    return whole;
}

}  // namespace sand::tin
