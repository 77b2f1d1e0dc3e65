// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/live_histogram.hpp"

namespace haptic_bridge {

/// Writes named histograms as CSV. A row holds the name, the shortest duration of a bucket [us], and its count. Empty
/// buckets are left out. Throws base::InputError if the file cannot be written.
void writeTimings(const std::string& file,
                  const std::vector<std::pair<std::string, const base::LiveHistogram*>>& histograms);

}  // namespace haptic_bridge
