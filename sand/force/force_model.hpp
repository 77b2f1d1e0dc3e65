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

/// The law of a scene between two surfaces: asked at 1 kHz, while the sand changes at 60 Hz. Used by one thread; asks
/// for no memory after it was made.
///
/// Between::local carries the last surface's tangent on (LocalModel); hold repeats the force that the last surface gave
/// when it came; interpolate is the second paper's equation 9 (Interpolation).
class ForceModel {
public:
    explicit ForceModel(const ForceConstants& constants) : constants_(constants) {}

    /// `step` is the one that made the surface: another one replaces what is known of it. `time` [s] never runs
    /// backwards; after kForget without a question, nothing is carried over from before.
    [[nodiscard]] Response at(const SurfacePatch& surface, std::uint64_t step, const Contour& tool,
                              Vec3 place /* [scene unit] */, double time);

    static constexpr double kForget = 0.05;  // [s]

private:
    ForceConstants constants_;
    LocalModel local_;
    Interpolation interpolation_;
    Response held_;
    bool known_ = false;  // of the last surface
    std::uint64_t step_ = 0;
    double time_ = 0;  // [s], of the last question
};

}  // namespace sand::force
