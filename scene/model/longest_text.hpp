// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace scene {

inline constexpr std::size_t kLongestText = 1 << 16;  // [byte] in an encoded scene; the longest WKT takes a tenth of it

}  // namespace scene
