// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/hand/pointer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/byte_stream.hpp"

namespace haptic_bridge {

bool PointerReport::touches() const {
    const auto samplesNow = taken();
    return pressed != 0 || std::any_of(samplesNow.begin(), samplesNow.end(),
                                       [](const PointerSample& sample) { return sample.pressed != 0; });
}

bool PointerReport::movesView() const {
    return wheel != 0 || turnX != 0 || turnY != 0 || pan != std::array<float, 3>{};
}

void requireValid(const PointerReport& report) {
    if (report.count > PointerReport::kMostSamples) {
        throw base::FormatError(fmt::format("a pointer with {} places", report.count));
    }
    for (const float number : {report.wheel, report.depth, report.size, report.turnX, report.turnY, report.wheelAt[0],
                               report.wheelAt[1], report.wheelAt[2], report.pan[0], report.pan[1], report.pan[2]}) {
        if (!std::isfinite(number)) {
            throw base::FormatError("a pointer with a number that is not finite");
        }
    }
    constexpr std::int64_t kLatest = std::int64_t{1} << 62;  // [ns], so that sums and differences never overflow
    for (const PointerSample& sample : report.taken()) {
        if (sample.readNs < 0 || sample.readNs >= kLatest) {
            throw base::FormatError(fmt::format("a pointer at the time {} ns", sample.readNs));
        }
        for (const std::int32_t number : {sample.probe.x, sample.probe.y, sample.probe.z}) {
            if (number < -sand::kMaxProbe || number >= sand::kMaxProbe) {
                throw base::FormatError(fmt::format("a pointer at {}", number));
            }
        }
    }
}

}  // namespace haptic_bridge
