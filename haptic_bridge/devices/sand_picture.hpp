// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <vector>

#include "haptic_bridge/devices/picture_window.hpp"
#include "sand/force/vec3.hpp"
#include "sand/replica.hpp"

namespace haptic_bridge {

/// Reduced copy of the sand for a window. It keeps every n-th cell, so that copying is quick.
struct SandSketch {
    static constexpr int kMostSide = 384;  // [cell], largest side of the copy
    int columns = 0, rows = 0;
    std::vector<float> heights;  // [kept cell], rows from south to north
    double toolRadius = 0;       // [half side], as in hand space
    std::uint64_t step = 0;

    /// Copies the sand of `terrain`. Allocates memory only at the first call.
    void take(const sand::Replica& terrain);
};

/// Place of the hand in the picture, and the force that it feels.
struct SketchedHand {
    double x = 0, y = 0;  // [hand space]
    bool touches = false;
    double depth = 0.5;       // [tool radius], depth of the underside when the tool touches the sand
    sand::force::Vec3 force;  // [N], east, north, up
};

/// The field's rectangle in a picture: as large as fits, centred.
struct SketchFrame {
    double left = 0, top = 0, pixelsPerHalfSide = 1, halfWidth = 1, halfHeight = 1;  // the half sides in hand space
    static SketchFrame of(int width, int height, int columns, int rows);
    [[nodiscard]] double handX(double pixel) const { return (pixel - left) / pixelsPerHalfSide - halfWidth; }
    [[nodiscard]] double handY(double pixel) const { return halfHeight - (pixel - top) / pixelsPerHalfSide; }
    [[nodiscard]] double pixelX(double x) const { return left + (x + halfWidth) * pixelsPerHalfSide; }
    [[nodiscard]] double pixelY(double y) const { return top + (halfHeight - y) * pixelsPerHalfSide; }
};

/// Paints the sand from above, lit from the north-west, and the tool's circle. An arrow shows the horizontal force, and
/// a bar at the left edge its upward part. A bar at the right edge shows the depth that the wheel has set.
void paint(const SandSketch& sand, const SketchedHand& hand, Picture& picture);

}  // namespace haptic_bridge
