// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <algorithm>

#include "sand/tin/mesh/mesh.hpp"

namespace sand::tin {

/// What the triangles were before someone began to change them: each slot is kept when it is touched first.
class ChangeRecord {
public:
    /// To be called before a slot's corners or constraints change, or the place of a corner.
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
    /// What differs now; the next record begins here.
    /// `vertices`: whether anybody asks for those too.
    [[nodiscard]] Mesh::Change takeChange(const Triangles& mesh, bool vertices);
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
    [[nodiscard]] static Slot slotNow(std::int32_t slot, const Triangles& mesh);  // alive
    [[nodiscard]] Mesh::Difference difference(const Triangles& mesh) const;

    std::vector<std::uint32_t> touched_;  // by slot: the turn in which it was touched last
    std::uint32_t turn_ = 1;
    std::vector<Slot> before_;          // that were triangles
    std::vector<std::int32_t> unused_;  // that were none
};

}  // namespace sand::tin
