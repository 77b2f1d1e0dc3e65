// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace render_node {

/// Where the sand has changed lately, by revision. `Where` is anything that has around(a, b), which bounds both.
///
/// Of bounded length: old entries grow together, so that whoever asks for what happened since a revision long ago is
/// told of too large a part and never of too little.
template <class Where>
class DamageHistory {
public:
    struct Part {
        std::uint64_t revision;  // that changed it; the latest, where parts have grown together
        Where where;
    };
    static constexpr std::size_t kMostParts = 128;

    /// Revisions must not fall.
    void add(std::uint64_t revision, const Where& where) {
        parts_.push_back({revision, where});
        if (parts_.size() > kMostParts) {
            parts_[1].where = around(parts_[1].where, parts_[0].where);
            parts_.erase(parts_.begin());
        }
    }
    /// All that changed after that revision, the oldest first. Good until the next add().
    [[nodiscard]] std::span<const Part> since(std::uint64_t revision) const {
        const auto first =
            std::upper_bound(parts_.begin(), parts_.end(), revision,
                             [](std::uint64_t since, const Part& part) { return since < part.revision; });
        return {first, parts_.end()};
    }

private:
    std::vector<Part> parts_;  // by revision
};

}  // namespace render_node
