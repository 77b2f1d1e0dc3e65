// SPDX-License-Identifier: Apache-2.0
#include "render_node/pointer/sand_ray.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace render_node {
namespace {

struct Span {
    double from, end;  // along the ray, as multiples of ray.along
};

/// Returns the part of the ray within a box.
Span within(const Ray& ray, glm::dvec3 low, glm::dvec3 high) {
    Span span{0, std::numeric_limits<double>::infinity()};
    for (int axis = 0; axis < 3; ++axis) {
        if (ray.along[axis] == 0) {
            if (ray.from[axis] < low[axis] || ray.from[axis] > high[axis]) {
                return {0, -1};
            }
            continue;
        }
        const double a = (low[axis] - ray.from[axis]) / ray.along[axis];
        const double b = (high[axis] - ray.from[axis]) / ray.along[axis];
        span.from = std::max(span.from, std::min(a, b));
        span.end = std::min(span.end, std::max(a, b));
    }
    return span;
}

}  // namespace

std::optional<glm::dvec2> meetSand(const Ray& ray, const SandBody& sand) {
    // The box is a little higher than all sand, so that a ray from above enters it above the surface.
    const Span span = within(ray, {0, 0, sand.lowest}, {sand.width, sand.depth, sand.highest + sand.step});
    const auto at = [&](double t) { return ray.from + t * ray.along; };
    const auto below = [&](double t) {
        const glm::dvec3 place = at(t);
        return place.z <= sand.height(place.x, place.y);
    };
    if (!(span.from <= span.end) || !std::isfinite(span.end) || below(span.from)) {
        return std::nullopt;
    }
    const double length = (span.end - span.from) * glm::length(glm::dvec2(ray.along));
    const int count = static_cast<int>(std::max(1.0, std::ceil(length / sand.step)));
    double above = span.from;
    for (int i = 1; i <= count; ++i) {
        double hit = span.from + (span.end - span.from) * (static_cast<double>(i) / count);
        if (below(hit)) {
            for (int halving = 0; halving < 8; ++halving) {
                const double middle = (above + hit) / 2;
                (below(middle) ? hit : above) = middle;
            }
            return glm::dvec2(at(hit));
        }
        above = hit;
    }
    return std::nullopt;
}

}  // namespace render_node
