// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/mesh/change_record.hpp"

#include <algorithm>
#include <iterator>

#include "sand/tin/mesh/neighbourhood.hpp"

namespace sand::tin {

ChangeRecord::Slot ChangeRecord::slotNow(std::int32_t slot, const Triangles& mesh) {
    const Triangle& triangle = mesh.triangles[static_cast<std::size_t>(slot)];
    Slot now{slot, {}, {}};
    const auto first = static_cast<std::size_t>(std::min_element(triangle.corner.begin(), triangle.corner.end()) -
                                                triangle.corner.begin());
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t from = (first + i) % 3;
        now.piece.corner[i] = triangle.corner[from];
        now.piece.place[i] = mesh.places[static_cast<std::size_t>(triangle.corner[from])];
        now.constrained[i] = triangle.constrained[from];
    }
    return now;
}

void ChangeRecord::keep(std::int32_t slot, const Triangles& mesh) {
    if (alive(slot, mesh)) {
        before_.push_back(slotNow(slot, mesh));
    } else {
        unused_.push_back(slot);
    }
}

void ChangeRecord::clear() {
    before_.clear();
    unused_.clear();
    ++turn_;
}

Mesh::Difference ChangeRecord::difference(const Triangles& mesh) const {
    std::vector<Mesh::Piece> before, now;
    now.reserve(before_.size() + unused_.size());
    for (const Slot& old : before_) {
        const bool lives = alive(old.slot, mesh);
        const Slot slot = lives ? slotNow(old.slot, mesh) : Slot();
        if (!lives || slot.piece != old.piece) {
            before.push_back(old.piece);
            if (lives) {
                now.push_back(slot.piece);
            }
        }
    }
    for (const std::int32_t slot : unused_) {
        if (alive(slot, mesh)) {
            now.push_back(slotNow(slot, mesh).piece);
        }
    }
    std::sort(before.begin(), before.end());
    std::sort(now.begin(), now.end());
    // A triangle that has only moved to another slot is in neither list.
    Mesh::Difference difference;
    std::set_difference(before.begin(), before.end(), now.begin(), now.end(), std::back_inserter(difference.removed));
    std::set_difference(now.begin(), now.end(), before.begin(), before.end(), std::back_inserter(difference.added));
    return difference;
}

Mesh::Difference ChangeRecord::takeDifference(const Triangles& mesh) {
    Mesh::Difference taken = difference(mesh);
    clear();
    return taken;
}

Mesh::Change ChangeRecord::takeChange(const Triangles& mesh, bool vertices) {
    Mesh::Change change;
    for (const Slot& old : before_) {
        if (!alive(old.slot, mesh)) {
            change.triangles.push_back(old.slot);
            continue;
        }
        const Slot slot = slotNow(old.slot, mesh);
        if (old.piece != slot.piece || old.constrained != slot.constrained) {
            change.triangles.push_back(old.slot);
        }
    }
    std::copy_if(unused_.begin(), unused_.end(), std::back_inserter(change.triangles),
                 [&mesh](std::int32_t slot) { return alive(slot, mesh); });
    sortOnce(change.triangles);
    const Mesh::Difference difference = vertices ? this->difference(mesh) : Mesh::Difference();
    for (const auto* pieces : {&difference.removed, &difference.added}) {
        for (const Mesh::Piece& piece : *pieces) {
            change.vertices.insert(change.vertices.end(), piece.corner.begin(), piece.corner.end());
        }
    }
    sortOnce(change.vertices);
    clear();
    return change;
}

}  // namespace sand::tin
