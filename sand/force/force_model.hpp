// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "sand/force/contour.hpp"
#include "sand/force/surface_patch.hpp"
#include "sand/force/vec3.hpp"
#include "sand/scene.hpp"

namespace sand::force {

/// What the sand answers at one place. The velocity comes in last, because what of it is stable depends on the device:
/// friction is −drag · (velocity − (velocity · normal) normal).
struct Response {
    Vec3 push;             // [N], of the place alone
    Vec3 normal{0, 0, 1};  // unit; friction is across it
    double drag = 0;       // [N · frame/scene unit], a frame being 1/60 s
    double stiffness = 0;  // [N/scene unit], the steepest that push is here
};

/// The law of a scene between two surfaces: asked at 1 kHz, while the sand changes at 60 Hz. Used by one thread; asks
/// for no memory after it was made.
class ForceModel {
public:
    explicit ForceModel(const ForceConstants& constants) : constants_(constants) {}

    /// `step` is the one that made the surface: another one replaces what is known of it. `time` [s] never runs
    /// backwards.
    [[nodiscard]] Response at(const SurfacePatch& surface, std::uint64_t step, const Contour& tool,
                              Vec3 place /* [scene unit] */, double time);

private:
    ForceConstants constants_;
};

}  // namespace sand::force
