// SPDX-License-Identifier: Apache-2.0
#include "journal/memory_parts.hpp"

#include <algorithm>

namespace journal {

std::string MemoryParts::name(std::uint32_t part) const {
    return part == 1 ? name_ : name_ + "." + std::to_string(part);
}

void MemoryParts::read(std::uint32_t part, std::int64_t offset, std::int64_t size, base::Bytes& bytes) {
    const base::Bytes& all = parts_.at(part - 1);
    const auto from = all.begin() + std::min(offset, static_cast<std::int64_t>(all.size()));
    bytes.assign(from, from + std::min<std::ptrdiff_t>(size, all.end() - from));
}

}  // namespace journal
