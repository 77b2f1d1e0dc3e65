// SPDX-License-Identifier: Apache-2.0
#include "sand/ground.hpp"

#include <algorithm>

namespace sand {

Ground::Ground(int columns, int rows) : bed_(columns, rows) {
    for (int y = 0; y < rows; ++y) {
        std::fill_n(bed_.row(y), columns, kBottomless);
    }
}

}  // namespace sand
