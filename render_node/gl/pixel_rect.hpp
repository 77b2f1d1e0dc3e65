// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace render_node {

/// Rectangle of pixels: columns [x0, x1), rows [y0, y1). Row 0 is the lowest, as in GL.
struct PixelRect {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    [[nodiscard]] bool empty() const { return x0 >= x1 || y0 >= y1; }
    [[nodiscard]] std::int64_t area() const { return empty() ? 0 : std::int64_t{x1 - x0} * (y1 - y0); }
    friend bool operator==(const PixelRect&, const PixelRect&) = default;
};

/// Returns all pixels of a picture of this size.
[[nodiscard]] constexpr PixelRect allPixels(glm::ivec2 size) { return {0, 0, size.x, size.y}; }

/// Returns the smallest rectangle around both. Ignores an empty rectangle.
[[nodiscard]] PixelRect around(const PixelRect& a, const PixelRect& b);

/// Returns the pixels that are in both. It is empty if no pixel is.
[[nodiscard]] PixelRect overlap(const PixelRect& a, const PixelRect& b);

/// Returns at most `most` rectangles that cover all of `rects`. Joins two rectangles if there are more than `most`, or
/// if at most `pass` pixels lie between them. `pass` is the fixed cost of drawing one more rectangle, as a number of
/// pixels.
[[nodiscard]] std::vector<PixelRect> fewCovering(std::vector<PixelRect> rects, std::size_t most, std::int64_t pass);

/// Returns the pixels that any object within the convex hull of these points may cover or touch, in a picture of
/// `size`. The result is never too small; it includes one more pixel on every side. It is empty if the hull lies
/// outside the picture or behind the near plane.
[[nodiscard]] PixelRect pixelsOf(std::span<const glm::dvec3> hull, const glm::dmat4& sceneToClip, glm::ivec2 size);

/// Returns a matrix from clip coordinates of the whole picture to coordinates in which `pixels` extends from -1 to 1.
/// It serves to cull objects outside `pixels`. It must not be used for drawing, because the rasteriser would round
/// differently.
[[nodiscard]] glm::dmat4 clipOf(const PixelRect& pixels, glm::ivec2 size);

}  // namespace render_node
