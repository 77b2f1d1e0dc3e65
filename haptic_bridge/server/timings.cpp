// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/server/timings.hpp"

#include <fmt/format.h>

#include <fstream>

#include "base/input_error.hpp"

namespace haptic_bridge {

void writeTimings(const std::string& file,
                  const std::vector<std::pair<std::string, const base::LiveHistogram*>>& histograms) {
    std::ofstream stream(file);
    stream << "what,from_us,count\n";
    for (const auto& [what, histogram] : histograms) {
        histogram->eachBucket([&stream, &what = what](double lowestNs, std::uint64_t count) {
            stream << fmt::format("{},{},{}\n", what, lowestNs * 1e-3, count);
        });
    }
    stream.flush();
    if (!stream) {
        throw base::InputError("--timings " + file + ": cannot be written");
    }
}

}  // namespace haptic_bridge
