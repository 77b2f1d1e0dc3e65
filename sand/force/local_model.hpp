// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sand/force/law.hpp"

namespace sand::force {

/// The local linear model: the sand as the law saw it at the last stable surface, and its tangent there.
///
/// What is linear is what the law reads (Gauges), not the force: value and Jacobian where the model was made are the
/// law's own, and away from there a force neither pulls nor misses that the tool has left the sand.
///
/// Two things are not the tangent's. Sand that the tool pushes goes with it, and does not rise as the tangent across it
/// says: what share of the tangent came true on the last bit of way is believed on the next. And when a surface is
/// replaced, or the tool leaves the radius within which the tangent is believed, the new one takes over with the time
/// constant ForceConstants::recoveryTime, as if the sand had moved that slowly: no force jumps.
///
/// Sand that a press has raised answers a frame late, as a spring with a delay, which gives energy to the hand that it
/// pushes back late. So a change of the force that goes along with the tool's motion waits until it does not, or takes
/// ten times as long (docs/figures.md has the energies).
class LocalModel {
public:
    /// The gauges at `place`. `replaced`: the surface is not the last call's. `forget`: nothing is known of before.
    [[nodiscard]] Gauges at(const ForceConstants& constants, const SurfacePatch& surface, bool replaced, bool forget,
                            const Contour& tool, Vec3 place, double time);

private:
    [[nodiscard]] Gauges carriedBy(Vec3 step) const;
    void learn(const Gauges& before, Vec3 step);
    void recover(const ForceConstants& constants, const Contour& tool, double span /* [s] */);

    Gauges tangent_, mark_;
    Vec3 origin_, markPlace_;                    // of either
    std::array<double, Gauges::kMost> share_{};  // of the tangent that comes true across, 0 to 1
    std::array<double, Gauges::kMost> debt_{};   // by how much the gauges are still what they were before
    Vec3 place_, motion_;                        // of the last call; motion a tick, averaged
    double time_ = 0;                            // [s], of the last call
};

}  // namespace sand::force
