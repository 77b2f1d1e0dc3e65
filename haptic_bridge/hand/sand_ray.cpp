// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/hand/sand_ray.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace haptic_bridge {
namespace {

struct Span {
    double from, end;  // along the ray, as multiples of ray.along
};

/// Cuts `span` to the part of the ray within a box, along one axis.
void cut(Span& span, double from, double along, double low, double high) {
    if (along == 0) {
        span = from < low || from > high ? Span{0, -1} : span;
        return;
    }
    const double a = (low - from) / along;
    const double b = (high - from) / along;
    span.from = std::max(span.from, std::min(a, b));
    span.end = std::min(span.end, std::max(a, b));
}

/// Returns the part of the ray above the field. Its box is a little higher than all sand, so that a ray from above
/// enters it above the surface.
Span within(const Ray& ray, const SandBody& sand) {
    Span span{0, std::numeric_limits<double>::infinity()};
    cut(span, ray.from.x, ray.along.x, 0, sand.width);
    cut(span, ray.from.y, ray.along.y, 0, sand.depth);
    cut(span, ray.from.z, ray.along.z, sand.lowest, sand.highest + sand.step);
    return span;
}

}  // namespace

std::optional<FieldPlace> meetSand(const Ray& ray, const SandBody& sand) {
    const Span span = within(ray, sand);
    const auto at = [&](double t) { return ray.from + t * ray.along; };
    const auto below = [&](double t) {
        const sand::force::Vec3 place = at(t);
        return place.z <= sand.height(place.x, place.y);
    };
    if (!(span.from <= span.end) || !std::isfinite(span.end) || below(span.from)) {
        return std::nullopt;
    }
    const double length = (span.end - span.from) * std::sqrt(ray.along.x * ray.along.x + ray.along.y * ray.along.y);
    const int count = static_cast<int>(std::max(1.0, std::ceil(length / sand.step)));
    double above = span.from;
    for (int i = 1; i <= count; ++i) {
        double hit = span.from + (span.end - span.from) * (static_cast<double>(i) / count);
        if (below(hit)) {
            for (int halving = 0; halving < 8; ++halving) {
                const double middle = (above + hit) / 2;
                (below(middle) ? hit : above) = middle;
            }
            return FieldPlace{at(hit).x, at(hit).y};
        }
        above = hit;
    }
    return std::nullopt;
}

}  // namespace haptic_bridge
