// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <algorithm>

#include "sand/tin/mesh/mesh.hpp"

namespace sand::tin {

/// Record of triangles as they were before a series of changes. Each slot is recorded when it is first touched.
class ChangeRecord {
public:
    /// Call this before a slot's corners or constraints change, or the place of a corner.
    void touch(std::int32_t slot, const Triangles& mesh) {
        const auto at = static_cast<std::size_t>(slot);
        if (at >= touched_.size()) [[unlikely]] {
            touched_.resize(mesh.triangles.size() + mesh.triangles.size() / 2 + 1, 0);
        }
        if (touched_[at] != turn_) {
            touched_[at] = turn_;
            keep(slot, mesh);
        }
    }
    void reserve(std::size_t slots) { touched_.resize(std::max(touched_.size(), slots), 0); }
    /// Returns the changes in this record, and begins the next record. Lists vertices only if `vertices` is true.
    [[nodiscard]] Mesh::Change takeChange(const Triangles& mesh, bool vertices);
    /// Returns the differences in this record, and begins the next record.
    [[nodiscard]] Mesh::Difference takeDifference(const Triangles& mesh);

private:
    struct Slot {
        std::int32_t slot;
        Mesh::Piece piece;
        std::array<bool, 3> constrained;
    };
    void keep(std::int32_t slot, const Triangles& mesh);
    void clear();
    [[nodiscard]] static bool alive(std::int32_t slot, const Triangles& mesh) {
        return mesh.triangles[static_cast<std::size_t>(slot)].alive();
    }
    [[nodiscard]] static Slot slotNow(std::int32_t slot, const Triangles& mesh);  // for living triangles only
    [[nodiscard]] Mesh::Difference difference(const Triangles& mesh) const;

    std::vector<std::uint32_t> touched_;  // by slot: record in which it was touched last
    std::uint32_t turn_ = 1;              // number of this record
    std::vector<Slot> before_;            // touched slots that had a triangle
    std::vector<std::int32_t> unused_;    // touched slots that were empty
};

}  // namespace sand::tin
