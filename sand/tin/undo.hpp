// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "base/index_set.hpp"
#include "sand/tin/snapshot.hpp"

namespace sand::tin {

/// Sand of a TIN that is kept from before a stroke. Every stroke calls keep(), so keep() costs only what has changed
/// since the last call. copy() encodes the bytes. Not thread-safe.
class Undo {
public:
    /// Begins without kept sand.
    explicit Undo(const VertexSand& layer) { replaced(layer); }
    /// Call this after the sand was replaced as a whole. Kept sand stays kept. The cost grows with the whole mesh.
    void replaced(const VertexSand& layer);

    void reserve(std::size_t vertices) {
        parts_.places.reserve(vertices);
        parts_.volumes.reserve(vertices);
        parts_.moving.reserve(vertices);
        vertices_.reserve(vertices);
        slots_.reserve(2 * vertices);
    }
    /// Call these for each change since the sand was last kept or replaced. The vertices may have come, gone or
    /// changed their volumes. The slots may have other triangles or constraints.
    void touch(const std::vector<Vertex>& vertices) { vertices_.add(vertices); }
    void touchTriangles(const std::vector<std::int32_t>& slots) { slots_.add(slots); }

    void keep(const VertexSand& layer, const TinState& state);
    void keep(std::shared_ptr<const Snapshot> copy);
    void forget();
    [[nodiscard]] bool any() const { return any_; }
    /// Returns the kept sand, or null if any() is false. The first call after keep() encodes the whole TIN.
    [[nodiscard]] std::shared_ptr<const Snapshot> copy() const;

private:
    void followVertex(const VertexSand& layer, Vertex vertex);
    void followTriangle(const VertexSand& layer, std::int32_t slot);

    VertexSandParts parts_;  // without the constraints
    std::map<std::int32_t, std::vector<std::pair<Vertex, Vertex>>>
        constraints_;                   // by the slot that owns them; few slots own any
    base::IndexList vertices_, slots_;  // touched since keep() or replaced()
    TinState state_;
    bool any_ = false;
    mutable std::shared_ptr<const Snapshot> copy_;  // result of copy(), or the argument of keep()
};

}  // namespace sand::tin
