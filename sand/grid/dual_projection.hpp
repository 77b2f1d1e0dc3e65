// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sand/grid/dual_kernel.hpp"
#include "sand/grid/erosion.hpp"

namespace sand::grid {

/// The pile nearest to a field in which no quad is steeper than the talus, found through its fluxes.
///
/// Relaxed sand is close to the projection of the start, in the least-squares sense, onto the surfaces that are stable
/// everywhere (Prigozhin 1996). A quad's slope has the mean difference east, the mean difference north, and a twist,
/// without which a chequerboard would lie level. The dual unknown is the pressure of each quad: its maximum is sought
/// by proximal gradient steps with momentum (Beck and Teboulle 2009) that is dropped whenever it points downhill
/// (O'Donoghue and Candès 2015). The number of steps grows with the side of what moves, that of sweeps with its square.
///
/// Only a box around what moves is computed. It grows before the movement reaches its edge, so that the whole field
/// would give the same numbers. Heights between two iterations are no sand: they overshoot. Doubles and not floats:
/// with 512² cells in motion a float's last bit of pressure was 2 % of the talus.
class DualProjection {
public:
    static constexpr double kRelativeGap = 1e-5;  // of the squared change: 0.0033 % of a cylinder is misplaced at 512²

    /// Heights at an open rim must not lie below 0: there sand falls out of the field, never into it.
    DualProjection(const HeightField& field, const Rules& rules, CodePath path = CodePath::automatic);

    /// Whether no quad is too steep at the start.
    [[nodiscard]] bool atRest() const { return box_.empty(); }

    /// Iterates until the relative duality gap is small enough, or a cap, and returns the number of iterations.
    int run(double relativeGap = kRelativeGap);

    /// Takes over the pressures on a field of half as many columns and rows, rounded up, with heights in units of its
    /// own cells. Before run(); sand/grid/multigrid_start.hpp says what for.
    void startFrom(const DualProjection& coarse);

    /// Cells, rim included, whose faces may have fluxes: a cell outside has none.
    [[nodiscard]] const CellRect& box() const { return box_; }
    /// What the projection sends through a cell's eastern and northern face [unit · cell], rounded. A cell of the ring
    /// around an open field has faces too.
    [[nodiscard]] std::int64_t eastFlux(int column, int row) const;
    [[nodiscard]] std::int64_t northFlux(int column, int row) const;

private:
    static constexpr int kCheckEvery = 16;           // [iteration]; one carries pressure at most one quad further
    static constexpr int kMargin = kCheckEvery + 1;  // [quad], free of pressure around whatever has some

    struct Measures {
        double gap = 0, moved = 0, excess = 0;
    };

    [[nodiscard]] std::int32_t startHeight(int column, int row) const;
    [[nodiscard]] CellRect steepQuads() const;
    [[nodiscard]] double pressure(std::size_t component, int column, int row) const;
    // Of a coarser projection, and of one that starts from it (sand/grid/multigrid_start.cpp).
    [[nodiscard]] double pressureBeyond(std::size_t component, int column, int row) const;
    [[nodiscard]] CellRect pressedCells() const;
    void allocateFor(const DualProjection& coarse);
    void allocate(const CellRect& box);
    /// One step, and whether it turned back.
    bool iterate(double momentum, Measures* measures);
    [[nodiscard]] bool nearEdge() const;
    void grow();

    const HeightField& field_;
    Rules rules_;
    bool v3_;
    double northing_;  // slope north per difference, over slope east per difference
    double twist_;     // weight of the twist: as much as leaves the slope's norm, and with it the step, alone
    CellRect domain_;  // the field, with a ring around it where the rim is open
    CellRect box_;     // the part of it that is computed
    std::ptrdiff_t stride_ = 0;
    std::array<std::vector<double>, 7> arrays_;  // start, pressure now, pressure before
    QuadPressure now_{}, before_{};
    std::vector<double> scratch_;
    std::array<std::vector<double>, 4> sums_;
};

}  // namespace sand::grid
