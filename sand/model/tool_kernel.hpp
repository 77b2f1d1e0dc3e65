// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace sand {

/// Cells side by side under a sphere.
struct SphereRow {
    std::int64_t square;  // of the radius, less that of the row's distance from the centre [probe unit²]; below 2^50
    std::int64_t first;   // of the first cell from the centre [probe unit]
    std::int64_t centre;  // [unit]
    int count;
};

// One source, compiled twice (sand/CMakeLists.txt), for the same integers. Undersides as TurnedShape's.
namespace baseline {
void undersidesOfSphere(const SphereRow& row, std::int32_t* undersides);
/// What lies above them [unit]; heights within kMaxHeight.
std::int64_t sandAbove(const std::int32_t* undersides, const std::int32_t* heights, int count);
}  // namespace baseline
namespace v3 {
void undersidesOfSphere(const SphereRow& row, std::int32_t* undersides);
std::int64_t sandAbove(const std::int32_t* undersides, const std::int32_t* heights, int count);
}  // namespace v3

}  // namespace sand
