// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "base/index_set.hpp"
#include "sand/tin/volume/vertex_sand.hpp"

namespace sand::tin {

/// Parts of a TIN as they were at one moment. All lists are in ascending order.
struct EarlierParts {
    using Edge = std::pair<Vertex, Vertex>;
    struct Was {
        std::int64_t volume = 0;  // [volume unit]
        LatticePoint place = VertexSandParts::kNowhere;
        Vertex vertex = 0;
        std::uint8_t moving = 0;
    };
    /// Whether there was a constraint.
    struct WasEdge {
        Edge edge;
        bool there = false;
    };
    std::vector<Was> vertices;
    std::vector<WasEdge> constraints;

    /// Adds the parts of `later`, which are of a later moment, that this object lacks.
    void addMissing(const EarlierParts& later);
    /// Puts these parts in place of those of `parts`, which has its constraints.
    void putInto(VertexSandParts& parts) const;
    [[nodiscard]] std::int64_t bytes() const;  // of memory
};

/// Copy of the parts of a VertexSand. It is brought up to date from time to time. The cost grows with the number of
/// changed parts alone. Not thread-safe.
class FollowedParts {
public:
    explicit FollowedParts(const VertexSand& layer) { replaced(layer); }

    void reserve(std::size_t vertices);
    /// Call these for each change. The vertices may have come, gone or changed their volumes. The slots may have other
    /// triangles or constraints.
    void touch(const std::vector<Vertex>& vertices) { vertices_.add(vertices); }
    void touchTriangles(const std::vector<std::int32_t>& slots) { slots_.add(slots); }
    /// Call it after the whole sand has changed to that of `layer`.
    void touchAll(const VertexSand& layer);
    /// Copies the whole of `layer`, in place of touchAll() and bringUpToDate().
    void replaced(const VertexSand& layer);

    void bringUpToDate(const VertexSand& layer);
    /// Brings the copy up to date. Returns what has changed, as it was before.
    [[nodiscard]] EarlierParts takeChanges(const VertexSand& layer);

    /// Returns the parts that `parts` has, as they are in this copy.
    [[nodiscard]] EarlierParts presentOf(const EarlierParts& parts) const;
    /// Returns the copied parts, with their constraints.
    [[nodiscard]] VertexSandParts parts() const;

private:
    void followVertex(const VertexSand& layer, Vertex vertex);
    void followTriangle(const VertexSand& layer, std::int32_t slot);
    [[nodiscard]] EarlierParts::Was vertexAt(Vertex vertex) const;
    [[nodiscard]] std::vector<EarlierParts::Edge> constraintsOfTouched() const;
    [[nodiscard]] std::vector<EarlierParts::Edge> constraints() const;  // in ascending order

    VertexSandParts parts_;  // without the constraints
    std::map<std::int32_t, std::vector<EarlierParts::Edge>>
        constraints_;                   // by the slot that owns them; few slots own any
    base::IndexList vertices_, slots_;  // touched since the copy was up to date
};

}  // namespace sand::tin
