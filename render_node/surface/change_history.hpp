// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace render_node {

/// List of the places where the sand has changed recently, by revision. `Where` is any type with a function around(a,
/// b) that returns a bound of both.
///
/// The list has a bounded length, because old entries are joined. A query for an old revision may return too large a
/// part, but never too small a part.
template <class Where>
class ChangeHistory {
public:
    struct Part {
        std::uint64_t revision;  // of the change; the latest one if parts were joined
        Where where;
    };
    static constexpr std::size_t kMostParts = 128;

    /// Adds a change. `revision` must not be less than that of an earlier change.
    void add(std::uint64_t revision, const Where& where) {
        parts_.push_back({revision, where});
        if (parts_.size() > kMostParts) {
            parts_[1].where = around(parts_[1].where, parts_[0].where);
            parts_.erase(parts_.begin());
        }
    }
    /// Returns all changes after `revision`, oldest first. Valid until the next add().
    [[nodiscard]] std::span<const Part> since(std::uint64_t revision) const {
        const auto first =
            std::upper_bound(parts_.begin(), parts_.end(), revision,
                             [](std::uint64_t since, const Part& part) { return since < part.revision; });
        return {first, parts_.end()};
    }

private:
    std::vector<Part> parts_;  // in the order of revisions
};

}  // namespace render_node
