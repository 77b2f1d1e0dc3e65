// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "lockstep/key_list.hpp"

namespace render_node {

inline constexpr std::size_t kMostKeys = 8;

/// Removes the key that the next arrival carries from `waiting`, and returns it, or a key without code if none waits.
/// It is the oldest key, but one that ends the session comes before all others: a key that was held down must not delay
/// the end of a slow session. At most kMostKeys other keys stay, because a held key must not act long after its
/// release.
[[nodiscard]] inline base::Keystroke takeNextKey(std::vector<base::Keystroke>& waiting) {
    if (waiting.empty()) {
        return {};
    }
    const auto quits = std::ranges::find_if(waiting, lockstep::isQuitKey);
    const auto next = quits == waiting.end() ? waiting.begin() : quits;
    const base::Keystroke key = *next;
    waiting.erase(next);
    waiting.resize(std::min(waiting.size(), kMostKeys));
    return key;
}

}  // namespace render_node
