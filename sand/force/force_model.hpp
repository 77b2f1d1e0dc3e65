// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "sand/force/contour.hpp"
#include "sand/force/force_constants.hpp"
#include "sand/force/interpolation.hpp"
#include "sand/force/local_model.hpp"
#include "sand/force/response.hpp"
#include "sand/force/surface_patch.hpp"
#include "sand/force/vec3.hpp"

namespace sand::force {

/// The force law of a scene: computes at 1 kHz how the sand resists the tool, while the sand changes at 60 Hz.
///
/// A surface is the sand around the tool after one step. ForceConstants::between selects what the model returns between
/// two surfaces:
/// - Between::local follows the tangent of the last surface at the tool (LocalModel).
/// - Between::hold repeats the response that the law gave when the last surface arrived.
/// - Between::interpolate applies equation 9 of Purchart et al. 2012 (Interpolation).
///
/// Threads: use it from one thread. It allocates no memory after construction.
class ForceModel {
public:
    explicit ForceModel(const ForceConstants& constants) : constants_(constants) {}

    /// Returns the response of the sand to `tool` with its centre at `place`.
    ///
    /// `step` is the number of the step that made `surface`; another number means another surface. `time` [s] must
    /// never decrease. If the last call was more than kForget ago, or if `edited` says that an operator has replaced
    /// sand or tool, the result does not depend on earlier calls. Returns a response without a force, and forgets
    /// earlier calls, if `surface` is empty or `tool` has no reach.
    [[nodiscard]] Response at(const SurfacePatch& surface, std::uint64_t step, const Contour& tool,
                              Vec3 place /* [scene unit] */, double time, bool edited = false);

    static constexpr double kForget = 0.05;  // longest time between two calls that belong together [s]

private:
    ForceConstants constants_;
    LocalModel local_;
    Interpolation interpolation_;
    Response held_;           // the law's response when the last surface arrived
    bool known_ = false;      // whether step_ and time_ are those of a last call
    std::uint64_t step_ = 0;  // of the last call
    double time_ = 0;         // of the last call [s]
};

}  // namespace sand::force
