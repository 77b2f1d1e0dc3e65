// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/server/timings.hpp"

#include <fmt/format.h>

#include "base/input_error.hpp"
#include "host/whole_file.hpp"

namespace haptic_bridge {

void writeTimings(const std::string& file,
                  const std::vector<std::pair<std::string, const base::LiveHistogram*>>& histograms) {
    try {
        host::WholeFile whole(file);
        whole.stream() << "what,from_us,count\n";
        for (const auto& [what, histogram] : histograms) {
            histogram->eachBucket([&stream = whole.stream(), &name = what](double lowestNs, std::uint64_t count) {
                stream << fmt::format("{},{},{}\n", name, lowestNs * 1e-3, count);
            });
        }
        whole.keep();
    } catch (const base::InputError& error) {
        throw base::InputError(std::string("--timings ") + error.what());
    }
}

}  // namespace haptic_bridge
