// SPDX-License-Identifier: Apache-2.0
#include "sand/start.hpp"

#include <utility>

namespace sand {

void Start::beginAs(tin::TinStart start) {
    tin = std::make_shared<const tin::TinStart>(std::move(start));
    rules.tin = tin->digest();
    terrain = HeightField(1, 1, terrain.cellSize());
}

std::int32_t Start::referenceHeight() const {
    if (tin != nullptr) {
        return tin->meanHeight;
    }
    const std::int64_t cells = std::int64_t{terrain.columns()} * terrain.rows();
    return static_cast<std::int32_t>(terrain.volume() / cells);
}

}  // namespace sand
