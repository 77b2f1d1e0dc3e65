// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace render_node {

/// Pixels of a picture: columns [x0, x1), rows [y0, y1); row 0 is the lowest, as GL counts.
struct PixelRect {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    [[nodiscard]] bool empty() const { return x0 >= x1 || y0 >= y1; }
    [[nodiscard]] std::int64_t area() const { return empty() ? 0 : std::int64_t{x1 - x0} * (y1 - y0); }
    friend bool operator==(const PixelRect&, const PixelRect&) = default;
};

/// The smallest rectangle around both; an empty one counts for nothing.
[[nodiscard]] PixelRect around(const PixelRect& a, const PixelRect& b);

/// At most `most` rectangles that cover all that these do. Two become one where they are too many, or unless the pixels
/// between them are more than `pass`: what one rectangle more costs who draws them, whatever lies in it [pixel].
[[nodiscard]] std::vector<PixelRect> fewCovering(std::vector<PixelRect> rects, std::size_t most, std::int64_t pass);

/// The pixels of a picture of `size` that something within the convex hull of these points may cover or touch: never
/// one too few, and a pixel more on every side. Empty when the hull lies outside the picture or behind its near plane.
[[nodiscard]] PixelRect pixelsOf(std::span<const glm::dvec3> hull, const glm::dmat4& sceneToClip, glm::ivec2 size);

/// Turns clip coordinates of the whole picture into those in which `pixels` alone reach from -1 to 1: for leaving out
/// what these pixels do not show, not for drawing, as the rasteriser would round differently.
[[nodiscard]] glm::dmat4 clipOf(const PixelRect& pixels, glm::ivec2 size);

}  // namespace render_node
