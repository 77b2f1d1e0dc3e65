// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "sand/tin/followed_parts.hpp"
#include "sand/tin/snapshot.hpp"

namespace sand::tin {

/// Sand of a TIN that is kept from before a stroke. Every stroke calls keep(), so keep() costs only what has changed
/// since the last call. copy() encodes the bytes. Not thread-safe.
class Undo {
public:
    /// Begins without kept sand.
    explicit Undo(const VertexSand& layer) : parts_(layer) {}
    /// Call this after the sand was replaced as a whole. Kept sand stays kept. The cost grows with the whole mesh.
    void replaced(const VertexSand& layer);

    void reserve(std::size_t vertices) { parts_.reserve(vertices); }
    /// Call these for each change since the sand was last kept or replaced. The vertices may have come, gone or
    /// changed their volumes. The slots may have other triangles or constraints.
    void touch(const std::vector<Vertex>& vertices) { parts_.touch(vertices); }
    void touchTriangles(const std::vector<std::int32_t>& slots) { parts_.touchTriangles(slots); }

    void keep(const VertexSand& layer, const TinState& state);
    void keep(std::shared_ptr<const Snapshot> copy);
    void forget();
    [[nodiscard]] bool any() const { return any_; }
    /// Returns the kept sand, or null if any() is false. The first call after keep() encodes the whole TIN.
    [[nodiscard]] std::shared_ptr<const Snapshot> copy() const;

private:
    FollowedParts parts_;  // as of the last keep() or replaced()
    TinState state_;
    bool any_ = false;
    mutable std::shared_ptr<const Snapshot> copy_;  // result of copy(), or the argument of keep()
};

}  // namespace sand::tin
