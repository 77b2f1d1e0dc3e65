// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "sand/model/height_field.hpp"
#include "sand/model/rules.hpp"

namespace sand::grid {

/// The squares between four cell centres of a field, and heights that may be moved. Around an open field lies a ring of
/// cells at height 0; one that is a single cell wide lies beside its mirror image, since quads need two. Not
/// thread-safe.
class QuadEnergy {
public:
    /// What belongs to a quad's southern, northern, western and eastern face; positive towards east and north.
    using Faces = std::array<double, 4>;

    QuadEnergy(const HeightField& field, const Rules& rules);

    /// Calls visit(x, y) for every quad, row by row, with the cell of the field at its south-west: -1 in the ring.
    template <class Visit>
    void forEach(Visit visit) const {
        for (int y = -ring_; y + ring_ + 1 < down_; ++y) {
            for (int x = -ring_; x + ring_ + 1 < across_; ++x) {
                visit(x, y);
            }
        }
    }
    /// Of the heights across the faces [unit], those towards north as the slope that they would be towards east.
    [[nodiscard]] Faces differences(int x, int y) const;
    /// The greatest root of half the sum of a quad's four squared differences [unit].
    [[nodiscard]] double steepest() const;
    /// Slope north per difference, over slope east per difference.
    [[nodiscard]] double northing() const { return northing_; }
    /// How often a cell counts: twice beside its mirror image.
    [[nodiscard]] double images() const;

    /// Moves heights a little, and by no more than it takes as far as iterating tells, until no quad is steeper than
    /// `threshold` [unit]: exactly, but for rounding.
    void flatten(double threshold);
    /// Summed over the cells [unit²], as often as they count; of the same field.
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
    int across_, down_;  // [cell], with the ring or the mirror image
    double northing_;
    std::vector<double> heights_;  // [unit], row by row
};

}  // namespace sand::grid
