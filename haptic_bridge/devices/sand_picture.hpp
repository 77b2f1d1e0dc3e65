// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <vector>

#include "haptic_bridge/devices/picture_window.hpp"
#include "sand/force/vec3.hpp"
#include "sand/replica.hpp"

namespace haptic_bridge {

/// The sand as a window shows it: every so many-th cell, so that a copy takes a moment.
struct SandSketch {
    static constexpr int kMostSide = 384;  // [cell] kept
    int columns = 0, rows = 0;
    std::vector<float> heights;  // [cell], rows from south to north
    double toolRadius = 0;       // [half side], as hand space has it
    std::uint64_t step = 0;

    /// Asks for memory the first time alone.
    void take(const sand::Replica& terrain);
};

/// Where the hand is in the picture, and what it feels.
struct SketchedHand {
    double x = 0, y = 0;  // hand space
    bool touches = false;
    double depth = 0.5;       // [tool radius], of the underside when it touches
    sand::force::Vec3 force;  // [N], east, north, up
};

/// The field's rectangle in a picture: as large as fits, in the middle.
struct SketchFrame {
    double left = 0, top = 0, pixelsPerHalfSide = 1, halfWidth = 1, halfHeight = 1;  // the latter in hand space
    static SketchFrame of(int width, int height, int columns, int rows);
    [[nodiscard]] double handX(double pixel) const { return (pixel - left) / pixelsPerHalfSide - halfWidth; }
    [[nodiscard]] double handY(double pixel) const { return halfHeight - (pixel - top) / pixelsPerHalfSide; }
    [[nodiscard]] double pixelX(double x) const { return left + (x + halfWidth) * pixelsPerHalfSide; }
    [[nodiscard]] double pixelY(double y) const { return top + (halfHeight - y) * pixelsPerHalfSide; }
};

/// Seen from above, lit from the north-west: the sand, the tool's circle, the force along the sand as an arrow and its
/// upward part as a bar at the left edge, the depth of the wheel as a bar at the right.
void paint(const SandSketch& sand, const SketchedHand& hand, Picture& picture);

}  // namespace haptic_bridge
