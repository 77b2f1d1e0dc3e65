// SPDX-License-Identifier: Apache-2.0
#include "render_node/gl/compiler_memory.hpp"

#include <malloc.h>
#include <sys/mman.h>

#include <cstdint>
#include <fstream>
#include <sstream>
#include <string>

namespace render_node {

void giveBackCompilerMemory() {
    malloc_trim(0);
    std::ifstream maps("/proc/self/maps");
    for (std::string line; std::getline(maps, line);) {
        // Only code pages can be dropped, because they equal the file. The library's tables hold addresses that the
        // loader wrote.
        if (line.find("/libLLVM") == std::string::npos || line.find(" r-xp ") == std::string::npos) {
            continue;
        }
        std::istringstream range(line);
        std::uintptr_t begin = 0;
        std::uintptr_t end = 0;
        char dash = 0;
        if (range >> std::hex >> begin >> dash >> end && begin < end) {
            // If the kernel refuses, only memory is lost.
            (void)madvise(reinterpret_cast<void*>(begin), end - begin, MADV_DONTNEED);
        }
    }
}

}  // namespace render_node
