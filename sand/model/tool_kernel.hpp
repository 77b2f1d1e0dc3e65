// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace sand {

/// Row of neighbouring cells under a sphere.
struct SphereRow {
    std::int64_t square;  // radius² minus the squared distance of the row from the centre [probe unit²]; below 2^50
    std::int64_t first;   // offset of the first cell from the centre [probe unit]
    std::int64_t centre;  // height of the centre [unit]
    int count;
};

// These functions are compiled twice from one source (sand/CMakeLists.txt). Both versions return the same integers. The
// undersides equal those of TurnedShape::undersides().
namespace baseline {
void undersidesOfSphere(const SphereRow& row, std::int32_t* undersides);
/// Returns the sum of the sand above the undersides [unit]. Heights must be within ±kMaxHeight.
std::int64_t sandAbove(const std::int32_t* undersides, const std::int32_t* heights, int count);
}  // namespace baseline
#if defined(__wasm__)
namespace v3 = baseline;  // one version, for WebAssembly
#else
namespace v3 {
void undersidesOfSphere(const SphereRow& row, std::int32_t* undersides);
std::int64_t sandAbove(const std::int32_t* undersides, const std::int32_t* heights, int count);
}  // namespace v3
#endif

}  // namespace sand
