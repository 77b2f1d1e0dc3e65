// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <functional>

namespace scene {

/// Receives the part of some work that is done, 0 to 1. It may be empty.
using Progress = std::function<void(double share)>;

/// Returns the progress of a piece of work that is the part [from, to] of `whole`. `whole` must outlive it.
[[nodiscard]] inline Progress partOf(const Progress& whole, double from, double to) {
    if (!whole) {
        return {};
    }
    return [&whole, from, to](double share) { whole(from + (to - from) * share); };
}

}  // namespace scene
