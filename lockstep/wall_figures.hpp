// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/byte_stream.hpp"

namespace lockstep {

/// A rank that keeps the wall waiting more often than any other, by far.
struct Drag {
    int rank = 0;       // 0: the master
    double share = 0;   // of frames
    double keptMs = 0;  // mean in these [ms]
    friend bool operator==(const Drag&, const Drag&) = default;
};

/// What a rank cannot know of the wall by itself, up to the frame before this one.
struct WallFigures {
    double frameMs = 0;                // from swap to swap; 0 when there is none yet
    std::optional<Drag> slowest;       // of the last frames; none where no rank stands out
    std::uint64_t agreed = 0;          // frames in which all hashes were equal
    std::uint64_t divergences = 0;     // frames in which they were not, at first
    std::uint64_t healed = 0;          // times that a rank took the right sand from another
    std::vector<std::uint32_t> swaps;  // by rank from 1: after the first swap of a frame [us]; empty when unknown

    void encode(base::ByteWriter& writer) const;
    /// Throws base::FormatError when cut short.
    static WallFigures decode(base::ByteReader& reader);
    friend bool operator==(const WallFigures&, const WallFigures&) = default;
};

}  // namespace lockstep
