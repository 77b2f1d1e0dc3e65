// SPDX-License-Identifier: Apache-2.0
#include "sand/start.hpp"

namespace sand {

std::int32_t Start::referenceHeight() const {
    if (tin != nullptr) {
        return tin->meanHeight;
    }
    const std::int64_t cells = std::int64_t{terrain.columns()} * terrain.rows();
    return static_cast<std::int32_t>(terrain.volume() / cells);
}

}  // namespace sand
