// SPDX-License-Identifier: Apache-2.0
#include "render_node/sand_damage.hpp"

#include <algorithm>

namespace render_node {

void SandDamage::add(const Part& part) {
    parts_.push_back(part);
    if (parts_.size() > kMostParts) {
        const Part& oldest = parts_[0];
        Part& next = parts_[1];
        next.vertices = next.vertices.joinedWith(oldest.vertices);
        next.heights = around(next.heights, oldest.heights);
        parts_.erase(parts_.begin());
    }
}

std::span<const SandDamage::Part> SandDamage::since(std::uint64_t revision) const {
    const auto first = std::upper_bound(parts_.begin(), parts_.end(), revision,
                                        [](std::uint64_t since, const Part& part) { return since < part.revision; });
    return {first, parts_.end()};
}

}  // namespace render_node
