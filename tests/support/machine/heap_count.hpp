// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace test {

/// Returns the number of heap allocations of this thread so far. Counts only in a program that links heap_count.cpp.
[[nodiscard]] long heapRequests();
/// Returns how many bytes these allocations have asked for.
[[nodiscard]] std::size_t heapBytes();

}  // namespace test
