// SPDX-License-Identifier: Apache-2.0
// Part of ActiveEdges: forgets triangles and edges that may no longer slide, or that a change of the mesh has removed.
#include <algorithm>

#include "sand/tin/flow/active_edges.hpp"

namespace sand::tin {
namespace {

constexpr std::size_t kSweepsToForget = 5;  // of all active sand; they take as long as forgetting a part of it

}  // namespace

bool ActiveEdges::manyRest() const {
    return restingVisits_ > static_cast<std::int64_t>(kSweepsToForget * sand_.vertexCount());
}

void ActiveEdges::keep(const ActiveMesh::Marks& kept) {
    const auto areAll = [](const std::vector<std::uint8_t>& marks) {
        return std::find(marks.begin(), marks.end(), 0) == marks.end();
    };
    if (areAll(kept.facets) && areAll(kept.edges)) {
        return;
    }
    const auto forget = [this](std::int32_t facet, std::uint8_t bit) {
        std::uint8_t& watched = noteOfSlot(slots_[index(facet)]).watched;
        watched = static_cast<std::uint8_t>(watched & ~bit);
    };
    std::size_t edges = 0;
    for (std::size_t i = 0; i < bits_.size(); ++i) {
        if (kept.edges[i] != 0) {
            bits_[edges++] = bits_[i];
            continue;
        }
        const Edge edge = sand_.edge(i);
        forget(edge.leftFacet, bits_[i].left);
        forget(edge.rightFacet, bits_[i].right);
    }
    bits_.resize(edges);
    const ActiveMesh::Renumbering now = sand_.keep(kept);
    const auto renumber = [](std::vector<std::int32_t>& names, const std::vector<std::int32_t>& by, const auto& local,
                             std::size_t count) {
        for (std::size_t i = 0; i < names.size(); ++i) {
            local(names[i]) = by[i];
            if (by[i] != kNoNumber) {
                names[index(by[i])] = names[i];
            }
        }
        names.resize(count);
    };
    const auto localOf = [this](Vertex vertex) -> std::int32_t& { return noteOf(vertex).local; };
    const auto facetOf = [this](std::int32_t slot) -> std::int32_t& { return noteOfSlot(slot).facet; };
    renumber(vertices_, now.vertices, localOf, sand_.vertexCount());
    renumber(slots_, now.facets, facetOf, sand_.facetCount());
}

void ActiveEdges::forgetResting() {
    restingVisits_ = 0;
    for (std::size_t i = 0; i < sand_.vertexCount(); ++i) {
        sand_.setWatched(i, sand_.flowed(i));
    }
    keep(sand_.whatMayFlow());
    restAround_ = sand_.restingCount();
}

std::vector<Vertex> ActiveEdges::meshChanged(const Mesh::Change& change) {
    std::erase_if(heldBack_, [&](const Held& one) {
        const bool gone = std::binary_search(change.vertices.begin(), change.vertices.end(), one.vertex);
        noteOf(one.vertex).isHeldBack = !gone;
        return gone;
    });
    ActiveMesh::Marks kept{std::vector<std::uint8_t>(sand_.facetCount(), 1),
                           std::vector<std::uint8_t>(sand_.edgeCount())};
    std::vector<std::uint8_t> staleVertices(sand_.vertexCount());
    for (const Vertex vertex : change.vertices) {
        if (index(vertex) < ofVertices_.size() && noteOf(vertex).local != kNoNumber) {
            staleVertices[index(noteOf(vertex).local)] = 1;
        }
    }
    std::vector<Vertex> corners;
    for (const std::int32_t slot : change.triangles) {
        if (index(slot) < ofSlots_.size() && noteOfSlot(slot).facet != kNoNumber) {
            kept.facets[index(noteOfSlot(slot).facet)] = 0;
            for (const std::int32_t corner : sand_.facet(noteOfSlot(slot).facet).corner) {
                corners.push_back(vertices_[index(corner)]);
                sand_.setWatched(index(corner), false);
            }
        }
    }
    // The weights of an edge depend on all corners of its facets.
    std::vector<std::uint8_t> known = kept.facets;
    for (std::size_t i = 0; i < known.size(); ++i) {
        for (const std::int32_t corner : sand_.facet(static_cast<std::int32_t>(i)).corner) {
            known[i] = staleVertices[index(corner)] != 0 ? 0 : known[i];
        }
    }
    for (std::size_t i = 0; i < kept.edges.size(); ++i) {
        const Edge edge = sand_.edge(i);
        kept.edges[i] = known[index(edge.leftFacet)] & known[index(edge.rightFacet)];
    }
    keep(kept);
    return corners;
}

void ActiveEdges::clear() {
    keep({std::vector<std::uint8_t>(sand_.facetCount()), std::vector<std::uint8_t>(sand_.edgeCount())});
}
}  // namespace sand::tin
