// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace bench {

/// Heights as in public sand and terrain codes: one float per cell [cell]. A rim of ghost cells repeats the edge, so
/// that no sand falls over it as long as the ground along the edge is level.
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

/// The talus rules in common use, for comparison only: sand above the talus flows to the lower neighbour.
///
/// Each rule gives the result of its sources. It works on whole rows with restricted pointers, which the compiler
/// vectorises. It has the flags and the instruction sets of our own sweeps. Every sweep visits the whole field, as the
/// sources do. `talus` is the largest stable difference between neighbours [cell].
enum class BaselineScheme {
    inPlaceN4,   // faces one after another, half of the excess each, as in soil and terrain simulators
    jacobiN4,    // all faces from the heights before the sweep, a quarter of the excess each
    jacobiN8,    // eight equal neighbours, an eighth of the excess each
    jacobiN8r2,  // eight neighbours, an eighth each; diagonal neighbours may differ by sqrt(2) times the talus
};

/// Runs one sweep over the whole field. `scratch` has the same size. Returns the largest amount that moved over a face
/// [cell]; for the Jacobi rules, the largest change of a cell [cell].
namespace baseline {
float sweep(BaselineScheme scheme, float talus, FloatField& field, FloatField& scratch);
}
namespace v3 {
float sweep(BaselineScheme scheme, float talus, FloatField& field, FloatField& scratch);
}

}  // namespace bench
