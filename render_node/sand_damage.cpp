// SPDX-License-Identifier: Apache-2.0
#include "render_node/sand_damage.hpp"

#include <algorithm>

namespace render_node {

void SandDamage::add(std::uint64_t revision, const Box& box) {
    parts_.push_back({revision, box});
    if (parts_.size() > kMostParts) {
        const Box& oldest = parts_[0].box;
        Box& next = parts_[1].box;
        next = {glm::min(next.low, oldest.low), glm::max(next.high, oldest.high)};
        parts_.erase(parts_.begin());
    }
}

std::span<const SandDamage::Part> SandDamage::since(std::uint64_t revision) const {
    const auto first = std::upper_bound(parts_.begin(), parts_.end(), revision,
                                        [](std::uint64_t since, const Part& part) { return since < part.revision; });
    return {first, parts_.end()};
}

}  // namespace render_node
