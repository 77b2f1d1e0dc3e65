// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace test {

/// How often this thread has asked the heap for memory. A program that links heap_count.cpp counts.
[[nodiscard]] long heapRequests();

}  // namespace test
