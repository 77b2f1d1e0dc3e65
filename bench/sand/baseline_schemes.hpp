// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace bench {

/// Heights as public sand and terrain codes keep them: one float a cell [cell], and a ghost cell all round that
/// repeats the edge, so that nothing falls over it as long as the ground along the edge is level.
struct FloatField {
    explicit FloatField(int sideCells)
        : side(sideCells),
          stride((sideCells + 2 + 15) / 16 * 16),
          heights(static_cast<std::size_t>(stride) * static_cast<std::size_t>(sideCells + 2)) {}

    [[nodiscard]] float* row(int y) { return heights.data() + (y + std::ptrdiff_t{1}) * stride + 1; }
    [[nodiscard]] const float* row(int y) const { return heights.data() + (y + std::ptrdiff_t{1}) * stride + 1; }
    void refreshGhosts() {
        for (int y = 0; y < side; ++y) {
            row(y)[-1] = row(y)[0];
            row(y)[side] = row(y)[side - 1];
        }
        std::copy_n(row(0) - 1, side + 2, row(-1) - 1);
        std::copy_n(row(side - 1) - 1, side + 2, row(side) - 1);
    }

    int side;
    int stride;
    std::vector<float> heights;
};

/// The talus rules in common use, written here for comparison only: sand above the talus goes to the lower neighbour.
///
/// Each computes what its sources compute, by whole rows and restricted pointers that the compiler vectorises, with
/// the flags and the instruction sets of our own sweeps. None visits less than the whole field: none of the sources
/// does. `talus` is the largest stable difference between neighbours [cell].
enum class BaselineScheme {
    inPlaceN4,   // faces one after another, half of the excess each: as soil and terrain simulators do it
    jacobiN4,    // all faces from the old heights, a quarter of the excess each
    jacobiN8,    // eight neighbours alike, an eighth each
    jacobiN8r2,  // eight neighbours, the diagonal ones allowed sqrt(2) times the difference, an eighth each
};

/// One sweep over the whole field; `scratch` is of the same size. Returns the largest amount that a face or, for the
/// Jacobi rules, a cell moved [cell].
namespace baseline {
float sweep(BaselineScheme scheme, float talus, FloatField& field, FloatField& scratch);
}
namespace v3 {
float sweep(BaselineScheme scheme, float talus, FloatField& field, FloatField& scratch);
}

}  // namespace bench
