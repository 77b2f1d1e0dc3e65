// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace sand {

/// What of a TIN differs from when it was asked for last.
struct TinChange {
    bool whole = false;                   // everything: the lists are then empty
    std::vector<std::int32_t> triangles;  // slots whose corners or constraints changed, or that came or went, ascending
    std::vector<std::int32_t> vertices;   // that came, went, rose or sank, ascending
};

}  // namespace sand
