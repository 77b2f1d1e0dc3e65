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

/// The sand of a TIN before a stroke, for an undo. Every stroke begins with keep(), so keep() costs only what has
/// changed since the last one. copy() makes the bytes. Not thread-safe.
class Undo {
public:
    /// Nothing is kept yet.
    explicit Undo(const VertexSand& layer) { replaced(layer); }
    /// The sand was replaced as a whole; what is kept stays. Costs the whole mesh.
    void replaced(const VertexSand& layer);

    void reserve(std::size_t vertices) {
        parts_.places.reserve(vertices);
        parts_.volumes.reserve(vertices);
        vertices_.reserve(vertices);
        slots_.reserve(2 * vertices);
    }
    /// These vertices may have come, gone, or have other sand, and these slots other triangles or constraints: since
    /// it was kept or replaced last.
    void touch(const std::vector<Vertex>& vertices) { vertices_.add(vertices); }
    void touchTriangles(const std::vector<std::int32_t>& slots) { slots_.add(slots); }

    void keep(const VertexSand& layer, const TinState& state);
    void keep(std::shared_ptr<const Snapshot> copy);
    void forget();
    [[nodiscard]] bool any() const { return any_; }
    /// Null when nothing is kept. Costs the whole the first time.
    [[nodiscard]] std::shared_ptr<const Snapshot> copy() const;

private:
    void followVertex(const VertexSand& layer, Vertex vertex);
    void followTriangle(const VertexSand& layer, std::int32_t slot);

    VertexSandParts parts_;  // but for the constraints
    std::map<std::int32_t, std::vector<std::pair<Vertex, Vertex>>>
        constraints_;                   // by the slot that owns them; few have any
    base::IndexList vertices_, slots_;  // touched
    TinState state_;
    bool any_ = false;
    mutable std::shared_ptr<const Snapshot> copy_;  // once somebody has asked, or what was given
};

}  // namespace sand::tin
