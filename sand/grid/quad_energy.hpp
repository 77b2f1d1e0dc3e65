// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "sand/model/height_field.hpp"
#include "sand/model/rules.hpp"

namespace sand::grid {

/// Quads of a field, with heights that can be moved. A quad is the square between four cell centres. A ring of cells at
/// height 0 surrounds an open field. A closed field that is one cell wide lies beside its mirror image, because quads
/// need two cells. Not thread-safe.
class QuadEnergy {
public:
    /// One number for each face of a quad: southern, northern, western, eastern. Numbers are positive towards east and
    /// north.
    using Faces = std::array<double, 4>;

    QuadEnergy(const HeightField& field, const Rules& rules);

    /// Calls visit(x, y) for every quad, row by row. (x, y) is the cell at the quad's south-west; -1 is in the ring.
    template <class Visit>
    void forEach(Visit visit) const {
        for (int y = -ring_; y + ring_ + 1 < down_; ++y) {
            for (int x = -ring_; x + ring_ + 1 < across_; ++x) {
                visit(x, y);
            }
        }
    }
    /// Returns the differences of height across the faces [unit]. A difference towards north is scaled to the
    /// difference towards east with the same slope.
    [[nodiscard]] Faces differences(int x, int y) const;
    /// Returns the largest slope of a quad [unit]: the square root of half the sum of its four squared differences.
    [[nodiscard]] double steepest() const;
    /// Returns the slope north per difference, divided by the slope east per difference.
    [[nodiscard]] double northing() const { return northing_; }
    /// Returns how often each cell counts. The mirror image doubles the count for each axis along which a closed field
    /// is one cell long.
    [[nodiscard]] double images() const;

    /// Moves heights until no quad is steeper than `threshold` [unit], except for rounding. The iteration keeps the
    /// changes small.
    void flatten(double threshold);
    /// Returns the squared distance to `other`, summed over the cells as often as they count [unit²]. Both must come
    /// from the same field.
    [[nodiscard]] double squaredDistanceTo(const QuadEnergy& other) const;

private:
    [[nodiscard]] std::size_t cell(int x, int y) const {
        return static_cast<std::size_t>(y + ring_) * static_cast<std::size_t>(across_) +
               static_cast<std::size_t>(x + ring_);
    }
    [[nodiscard]] bool touchesRing(int x, int y) const {
        return ring_ == 1 && (x < 0 || y < 0 || x + 3 == across_ || y + 3 == down_);
    }
    bool flattenRow(int y, double threshold);
    void shrink(double share);

    int columns_, rows_;
    int ring_;
    int across_, down_;  // size with the ring or the mirror image [cell]
    double northing_;
    std::vector<double> heights_;  // [unit], row by row
};

}  // namespace sand::grid
