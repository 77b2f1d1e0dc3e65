// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>

namespace render_node {

inline constexpr std::size_t kMostKeys = 8;

/// Removes the key that the next arrival carries from `waiting`, and returns it, or 0 if none waits. It is the oldest
/// key, but `quit` comes before all others: a key that was held down must not delay the end of a slow session. At
/// most kMostKeys other keys stay, because a held key must not act long after its release.
[[nodiscard]] inline char takeNextKey(std::string& waiting, char quit) {
    if (waiting.empty()) {
        return '\0';
    }
    const std::size_t found = waiting.find(quit);
    const std::size_t next = found == std::string::npos ? 0 : found;
    const char key = waiting[next];
    waiting.erase(next, 1);
    waiting.resize(std::min(waiting.size(), kMostKeys));
    return key;
}

}  // namespace render_node
