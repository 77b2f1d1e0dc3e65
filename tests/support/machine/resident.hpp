// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <cstdint>
#include <fstream>

namespace test {

/// Returns the resident memory of this process [byte].
[[nodiscard]] inline std::int64_t residentBytes() {
    std::ifstream stream("/proc/self/statm");
    std::int64_t total = 0, pages = 0;
    stream >> total >> pages;
    return pages * sysconf(_SC_PAGESIZE);
}

}  // namespace test
