// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "sand/force/force_constants.hpp"
#include "sand/force/response.hpp"

/// Whether a force law can be computed wherever a tool can be. A law whose numbers overflow has no stiffness to which a
/// device could be limited. These functions may be called from any thread and do not throw.
namespace sand::force {

/// Tools, depths and speeds for which the law of a scene must be finite.
///
/// The greatest depth is the field's longer side. By default an arm reaches 0.4 of the shorter side below the sand's
/// mean height. A tool's lowest point is one radius below its centre, and a tool is at most as long as the field. Only
/// a mapping of the user's own, a sphere larger than the field, or steep land can go deeper. There the guards push 0 if
/// a force is not finite.
struct LawRegion {
    static constexpr double kShortestReach = 0.005;  // [m], smallest reach of an arm
    static constexpr double kFastest = 20;           // [m/s], a faster arm counts as one that has jumped

    double smallestRadius, largestRadius;  // [scene unit], of the tools that an operator can choose
    double deepest;                        // [scene unit], the field's longer side
    double scale;                          // [scene unit/m], largest scale that an arm gets by default
    double fastest;                        // [scene unit/frame], kFastest at that scale; a frame is 1/60 s

    /// Returns the region of a field with `longerSide` cells of `cellSize` [scene unit].
    [[nodiscard]] static LawRegion of(int longerSide, double cellSize);
};

/// Returns whether all numbers are finite that a force loop computes from `felt` in the region. They contain squares,
/// and differences of two forces.
[[nodiscard]] bool isFinite(const Response& felt, const LawRegion& region);

/// A constant that makes a law not finite.
struct LawFault {
    const ForceKey* key;
    double value;
    double radius, depth;           // [scene unit], tool and depth at which the law is not finite
    bool atMost;                    // whether `allowed` is the largest allowed value, not the smallest
    std::optional<double> allowed;  // three digits; nullopt if another constant is at fault too
};

/// Returns what makes the chosen law not finite in the region; nullopt if it is finite. Evaluates the law at the ends
/// of the region and between, on level sand and on the steepest sand that heights can make. Both laws grow with the
/// depth, so that the greatest depth decides.
///
/// Also returns nullopt if no constant helps, because cells are so small that a slope per cell overflows: below about
/// 1e-300 scene units.
[[nodiscard]] std::optional<LawFault> faultOf(const ForceConstants& constants, const LawRegion& region);

/// Returns the depth_exponent of a scene that gives none [1/scene unit]: the default of ForceConstants, or the largest
/// one that is finite, with three digits. It is rounded because two programs that read a scene must agree, but the last
/// digit of libm's results differs between hosts.
[[nodiscard]] double usualDepthExponent(const ForceConstants& constants, const LawRegion& region);

}  // namespace sand::force
