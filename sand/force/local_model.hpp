// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sand/force/law.hpp"

namespace sand::force {

/// Local linear model: the sand as the law saw it at the last stable surface, and its tangent there.
///
/// The model is linear in the numbers that the law reads (Gauges), not in the force. At its origin, value
/// and Jacobian are therefore the law's own. Away from there, the force never pulls, and it ends where the tool leaves
/// the sand.
///
/// The model differs from the tangent in two ways. First, sand that the tool pushes moves with it, and does not rise as
/// the tangent across it predicts. The share of the tangent that came true on the last part of the way is assumed for
/// the next part. Second, a surface may be replaced, or the tool may leave the radius in which the tangent is valid.
/// The new tangent then takes over with the time constant ForceConstants::recoveryTime, as if the sand had moved that
/// slowly. With control points it takes twice as long while the hand moves up and down. The force therefore does not
/// jump.
///
/// Sand that a press has raised answers a frame late. It acts as a spring with a delay, which gives energy to the hand
/// because it pushes back late. A change of the force along the tool's motion therefore takes up to ten times as
/// long (docs/figures.md has the energies).
class LocalModel {
public:
    /// Returns the gauges at `place` at `time` [s]. `replaced` says that the surface is not that of the last call.
    /// `forget` says that the model knows no earlier call.
    [[nodiscard]] Gauges at(const ForceConstants& constants, const SurfacePatch& surface, bool replaced, bool forget,
                            const Contour& tool, Vec3 place, double time);

private:
    [[nodiscard]] Gauges carriedBy(Vec3 step) const;
    void learn(const Gauges& before, Vec3 step);
    void recover(const ForceConstants& constants, const Contour& tool, double span /* [s] */);

    Gauges tangent_, mark_;
    Vec3 origin_, markPlace_;                    // places where tangent_ and mark_ were measured
    std::array<double, Gauges::kMost> share_{};  // share of the tangent across that comes true, 0 to 1
    std::array<double, Gauges::kMost> debt_{};  // remaining difference of the gauges from those of the previous tangent
    Vec3 place_, motion_;                       // place of the last call; motion per tick, averaged
    double time_ = 0;                           // time of the last call [s]
};

}  // namespace sand::force
