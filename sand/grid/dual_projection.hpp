// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sand/grid/dual_kernel.hpp"
#include "sand/grid/erosion.hpp"
#include "sand/model/work_limit.hpp"

namespace sand::grid {

/// Projection of a field onto the piles in which no quad is steeper than the talus. It finds the fluxes to the nearest
/// such pile.
///
/// Relaxed sand is close to the least-squares projection of the start onto the surfaces that are stable everywhere
/// (Prigozhin 1996). The slope of a quad consists of the mean difference to the east, the mean difference to the north,
/// and a twist. Without the twist a chequerboard would count as level.
///
/// The unknown of the dual problem is the pressure of each quad. Proximal gradient steps with momentum (Beck and
/// Teboulle 2009) find the maximum. The momentum is reset whenever it points downhill (O'Donoghue and Candès 2015). The
/// number of steps grows with the side of the region that moves; the number of sweeps grows with the square of that
/// side.
///
/// Only a box around the moving sand is computed. The box grows before the movement reaches its edge, so that computing
/// the whole field would give the same numbers. Heights between two iterations overshoot and are not valid sand. The
/// numbers are doubles, because the last bit of a float's pressure was 2 % of the talus when 512² cells moved.
class DualProjection {
public:
    static constexpr double kRelativeGap = 1e-5;  // of the squared change; misplaces 0.0033 % of a cylinder at 512²

    /// Prepares the projection of `field`, which must outlive it. Heights at an open rim must not be below 0, because
    /// sand falls out of the field there and never into it.
    DualProjection(const HeightField& field, const Rules& rules, base::CodePath path = base::fastestCodePath());

    /// Returns whether no quad is too steep at the start.
    [[nodiscard]] bool atRest() const { return box_.empty(); }

    /// Iterates until the relative duality gap is small enough, until `limit` is reached, or up to a largest number of
    /// iterations. Returns the number of iterations. `limit` may be null.
    int run(double relativeGap = kRelativeGap, WorkLimit* limit = nullptr);

    /// Takes over the pressures of a projection on half as many columns and rows, rounded up, whose heights count in
    /// units of its own cells. Call it before run(); sand/grid/multigrid_start.hpp gives the reason.
    void startFrom(const DualProjection& coarse);

    /// Returns the cells whose faces may have fluxes, rim included. All other cells have no fluxes.
    [[nodiscard]] const CellRect& box() const { return box_; }
    /// Returns the rounded flux of the projection through a cell's eastern or northern face [unit · cell]. The cells of
    /// the ring around an open field have faces too.
    [[nodiscard]] std::int64_t eastFlux(int column, int row) const;
    [[nodiscard]] std::int64_t northFlux(int column, int row) const;

private:
    static constexpr std::int64_t kCost = 4;  // [cell of a sweep], time of a cell in an iteration
    static constexpr int kCheckEvery = 16;    // [iteration]; one iteration carries pressure at most one quad further
    static constexpr int kMargin =
        kCheckEvery + 1;  // [quad], width of the border without pressure around the quads with pressure

    struct Measures {
        double gap = 0, moved = 0, excess = 0;
    };

    [[nodiscard]] std::int32_t startHeight(int column, int row) const;
    [[nodiscard]] CellRect steepQuads() const;
    [[nodiscard]] double pressure(std::size_t component, int column, int row) const;
    // For a coarser projection and for the projection that starts from it (sand/grid/multigrid_start.cpp).
    [[nodiscard]] double pressureBeyond(std::size_t component, int column, int row) const;
    [[nodiscard]] CellRect pressedCells() const;
    void allocateFor(const DualProjection& coarse);
    void allocate(const CellRect& box);
    /// Takes one step. Returns whether the momentum pointed downhill.
    bool iterate(double momentum, Measures* measures);
    [[nodiscard]] bool nearEdge() const;
    void grow();

    const HeightField& field_;
    Rules rules_;
    base::CodePath path_;
    double northing_;  // slope north per difference, divided by slope east per difference
    double twist_;     // weight of the twist: the most that does not change the slope's norm, and with it the step
    CellRect domain_;  // the field, with a ring around it if the rim is open
    CellRect box_;     // the part of domain_ that is computed
    std::ptrdiff_t stride_ = 0;
    std::array<std::vector<double>, 7> arrays_;  // start, pressure now, pressure before
    QuadPressure now_{}, before_{};
    std::vector<double> scratch_;
    std::array<std::vector<double>, 4> sums_;
};

}  // namespace sand::grid
