// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "files/byte_stream.hpp"

namespace sand {

inline constexpr std::int32_t kLargestThreshold = 1 << 30;     // [unit]; differences never exceed 2^29: nothing slides
inline constexpr std::int32_t kLargestToolRadius = 2048 << 8;  // [probe unit], 2048 cells
inline constexpr std::int32_t kMostSweeps = 4096;              // per step

/// The rules that an operator may change while sand lies: derived once (material.hpp), then sent as numbers.
struct Tuning {
    std::int32_t threshold = 0, startThreshold = 0;  // [unit]
    std::int32_t sweepsPerStep = 0;
    std::int32_t toolRadius = 0;  // [probe unit]

    void encode(files::ByteWriter& writer) const {
        for (const std::int32_t number : {threshold, startThreshold, sweepsPerStep, toolRadius}) {
            writer.put(number);
        }
    }
    /// Throws files::FormatError for numbers that no scene file gives.
    static Tuning decode(files::ByteReader& reader) {
        Tuning tuning;
        for (std::int32_t* number :
             {&tuning.threshold, &tuning.startThreshold, &tuning.sweepsPerStep, &tuning.toolRadius}) {
            *number = reader.get<std::int32_t>();
        }
        const auto within = [](std::int32_t number, std::int32_t most) { return number >= 0 && number <= most; };
        if (!within(tuning.startThreshold, kLargestThreshold) || !within(tuning.threshold, tuning.startThreshold) ||
            !within(tuning.sweepsPerStep, kMostSweeps) || !within(tuning.toolRadius, kLargestToolRadius)) {
            throw files::FormatError("a material or tool out of range");
        }
        return tuning;
    }
    friend bool operator==(const Tuning&, const Tuning&) = default;
};

}  // namespace sand
