// SPDX-License-Identifier: Apache-2.0
#include "tests/sand/grid/two_pass/kernel.hpp"

namespace two_pass {

bool balance(const BalancePatch& patch) {
    std::int32_t moved = 0;
    for (int x = patch.cells.x0; patch.cells.y0 == 0 && x < patch.cells.x1; ++x) {
        moved |= patch.north[x - patch.fluxStride];  // over the southern rim
    }
    for (int y = patch.cells.y0; y < patch.cells.y1; ++y) {
        const std::int32_t* const east = patch.east + y * patch.fluxStride;
        const std::int32_t* const north = patch.north + y * patch.fluxStride;
        const std::int32_t* const south = north - patch.fluxStride;
        std::int32_t* const heights = patch.heights + y * patch.heightStride;
        moved |= patch.cells.x0 == 0 ? east[-1] : 0;
        for (int x = patch.cells.x0; x < patch.cells.x1; ++x) {
            heights[x] += east[x - 1] - east[x] + south[x] - north[x];
            moved |= east[x] | north[x];
            if (patch.sliding != nullptr) {
                patch.sliding[y * patch.slidingStride + x] =
                    (east[x - 1] | east[x] | south[x] | north[x]) != 0 ? -1 : 0;
            }
        }
    }
    return moved != 0;
}

}  // namespace two_pass
