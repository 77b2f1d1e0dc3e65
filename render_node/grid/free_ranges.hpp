// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>

namespace render_node {

/// Keeps which of the places 0 to `count` − 1 are free.
class FreeRanges {
public:
    explicit FreeRanges(int count) : free_{{0, count}} {}

    /// Takes `count` adjacent places, the first ones that are free. Returns the first of them, or nullopt if no free
    /// range is as long.
    [[nodiscard]] std::optional<int> take(int count) {
        const auto found = std::ranges::find_if(free_, [count](const auto& range) { return range.second >= count; });
        if (found == free_.end()) {
            return std::nullopt;
        }
        const auto [first, length] = *found;
        free_.erase(found);
        if (length > count) {
            free_.emplace(first + count, length - count);
        }
        return first;
    }

    /// Gives back a range that was taken.
    void giveBack(int first, int count) {
        const auto after = free_.lower_bound(first);
        if (after != free_.end() && after->first == first + count) {
            count += after->second;
            free_.erase(after);
        }
        const auto next = free_.lower_bound(first);
        if (next != free_.begin() && std::prev(next)->first + std::prev(next)->second == first) {
            std::prev(next)->second += count;
        } else {
            free_.emplace(first, count);
        }
    }

private:
    std::map<int, int> free_;  // first place and number of places; no two are adjacent
};

}  // namespace render_node
