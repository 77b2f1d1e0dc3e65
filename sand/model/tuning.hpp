// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "base/byte_stream.hpp"
#include "sand/model/tool.hpp"

namespace sand {

inline constexpr std::int32_t kLargestThreshold =
    1 << 30;                                       // [unit]; no sand slides then, because differences never exceed 2^29
inline constexpr std::int32_t kMostSweeps = 4096;  // most sweeps per step

/// Rules that an operator may change during a session. scene/material.hpp computes them once; then they are sent as
/// whole numbers.
struct Tuning {
    /// Largest stable height difference over one cell from west to east: tan(talus) · cell size [unit].
    std::int32_t threshold = 0;
    /// Height difference, over the same distance, beyond which sand at rest starts to slide [unit]. It is at least
    /// `threshold`; a larger value gives hysteresis.
    std::int32_t startThreshold = 0;
    std::int32_t sweepsPerStep = 0;
    Tool tool{};

    void encode(base::ByteWriter& writer) const;
    /// Reads what encode() wrote. Throws base::FormatError for numbers that no scene file can contain.
    static Tuning decode(base::ByteReader& reader);
    friend bool operator==(const Tuning&, const Tuning&) = default;
};

}  // namespace sand
