// SPDX-License-Identifier: Apache-2.0
#include "render_node/gl/pixel_rect.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace render_node {
namespace {

/// Converts a range of clip coordinates to pixels, rounded outward, with one more pixel, within [0, size].
std::pair<int, int> pixelsBetween(double low, double high, int size) {
    const auto pixel = [size](double along) { return (0.5 * along + 0.5) * size; };
    // GL's floats, and drivers that round to fractions of a pixel, may move an edge across a pixel's centre.
    const double from = std::clamp(std::floor(pixel(low)) - 1, 0.0, double(size));
    const double end = std::clamp(std::ceil(pixel(high)) + 1, 0.0, double(size));
    return {static_cast<int>(from), static_cast<int>(end)};
}

/// Returns the hull's points in front of the near plane, and the points where lines to the points behind it cross the
/// plane. Uses all pairs, not only the edges of the hull, because the other lines add only points within the hull.
std::vector<glm::dvec4> clippedToNear(std::span<const glm::dvec3> hull, const glm::dmat4& sceneToClip) {
    std::vector<glm::dvec4> before, behind;
    for (const glm::dvec3& point : hull) {
        const glm::dvec4 clip = sceneToClip * glm::dvec4(point, 1);
        (clip.z > -clip.w ? before : behind).push_back(clip);
    }
    std::vector<glm::dvec4> all = before;
    for (const glm::dvec4& a : before) {
        for (const glm::dvec4& b : behind) {
            const double inside = a.z + a.w;
            all.push_back(glm::mix(a, b, inside / (inside - (b.z + b.w))));
        }
    }
    return all;
}

constexpr std::size_t kManyRects = 32;  // all pairs of so few are checked quickly

/// Divides the area of all rectangles into 5 × 5 parts. Returns for each part one rectangle around all rectangles whose
/// middle lies in it.
std::vector<PixelRect> binned(const std::vector<PixelRect>& rects) {
    PixelRect all;
    for (const PixelRect& rect : rects) {
        all = around(all, rect);
    }
    constexpr int kAcross = 5;
    std::vector<PixelRect> bins(kAcross * kAcross);
    for (const PixelRect& rect : rects) {
        // NOLINTNEXTLINE(clang-analyzer-core.DivideZero): no rectangle is empty, so the area around them is not empty
        const int column = kAcross * ((rect.x0 + rect.x1) / 2 - all.x0) / (all.x1 - all.x0);
        const int row = kAcross * ((rect.y0 + rect.y1) / 2 - all.y0) / (all.y1 - all.y0);
        PixelRect& bin = bins[static_cast<std::size_t>(row * kAcross + column)];
        bin = around(bin, rect);
    }
    std::erase_if(bins, [](const PixelRect& rect) { return rect.empty(); });
    return bins;
}

}  // namespace

PixelRect around(const PixelRect& a, const PixelRect& b) {
    if (a.empty() || b.empty()) {
        return a.empty() ? b : a;
    }
    return {std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1), std::max(a.y1, b.y1)};
}

PixelRect overlap(const PixelRect& a, const PixelRect& b) {
    const PixelRect both{std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
    return both.empty() ? PixelRect{} : both;
}

std::vector<PixelRect> fewCovering(std::vector<PixelRect> rects, std::size_t most, std::int64_t pass) {
    std::erase_if(rects, [](const PixelRect& rect) { return rect.empty(); });
    if (rects.size() > kManyRects) {
        rects = binned(rects);
    }
    while (rects.size() > 1) {
        std::int64_t least = std::numeric_limits<std::int64_t>::max();
        std::size_t one = 0, other = 0;
        for (std::size_t i = 0; i < rects.size(); ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                const std::int64_t between = around(rects[i], rects[j]).area() - rects[i].area() - rects[j].area();
                if (between < least) {
                    least = between;
                    one = j;
                    other = i;
                }
            }
        }
        if (least > pass && rects.size() <= most) {
            break;
        }
        rects[one] = around(rects[one], rects[other]);
        rects.erase(rects.begin() + static_cast<std::ptrdiff_t>(other));
    }
    return rects;
}

PixelRect pixelsOf(std::span<const glm::dvec3> hull, const glm::dmat4& sceneToClip, glm::ivec2 size) {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    glm::dvec2 low(kFar), high(-kFar);
    for (const glm::dvec4& clip : clippedToNear(hull, sceneToClip)) {
        if (clip.w <= 0) {
            return allPixels(size);  // a wall has no such perspective; any pixel may be covered
        }
        low = glm::min(low, glm::dvec2(clip) / clip.w);
        high = glm::max(high, glm::dvec2(clip) / clip.w);
    }
    if (low.x > high.x) {
        return {};
    }
    const auto [x0, x1] = pixelsBetween(low.x, high.x, size.x);
    const auto [y0, y1] = pixelsBetween(low.y, high.y, size.y);
    const PixelRect pixels{x0, y0, x1, y1};
    return pixels.empty() ? PixelRect{} : pixels;
}

glm::dmat4 clipOf(const PixelRect& pixels, glm::ivec2 size) {
    const glm::dvec2 low = 2.0 * glm::dvec2(pixels.x0, pixels.y0) / glm::dvec2(size) - 1.0;
    const glm::dvec2 high = 2.0 * glm::dvec2(pixels.x1, pixels.y1) / glm::dvec2(size) - 1.0;
    const glm::dvec2 scale = 2.0 / (high - low);
    const glm::dvec2 centre = 0.5 * (low + high);
    glm::dmat4 narrowed(1);
    narrowed[0][0] = scale.x;
    narrowed[1][1] = scale.y;
    narrowed[3][0] = -scale.x * centre.x;
    narrowed[3][1] = -scale.y * centre.y;
    return narrowed;
}

}  // namespace render_node
