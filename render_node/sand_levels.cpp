// SPDX-License-Identifier: Apache-2.0
#include "render_node/sand_levels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace render_node {
namespace {

constexpr int kKeptCells = 512;

/// What interpolation over the triangles of a level is compared on.
struct Samples {
    std::vector<float> values;  // row by row
    int across;

    [[nodiscard]] float at(int x, int y) const {
        return values[static_cast<std::size_t>(y) * static_cast<std::size_t>(across) + static_cast<std::size_t>(x)];
    }
};

/// Where a vertex lies between two others, 0 … 1: the outermost ones of a field stand closer.
std::vector<float> sharesOf(const std::vector<float>& places, int stride) {
    std::vector<float> shares;
    for (int i = 0; i + 1 < static_cast<int>(places.size()); ++i) {
        const auto first = static_cast<std::size_t>(i / stride * stride);
        const float length = places[first + static_cast<std::size_t>(stride)] - places[first];
        shares.push_back(length > 0 ? (places[static_cast<std::size_t>(i)] - places[first]) / length : 0.0F);
    }
    shares.push_back(0);
    return shares;
}

/// The largest distance of the samples from the triangles between every stride-th of them.
float distance(const Samples& samples, int down, int stride, const std::vector<float>& shareEast,
               const std::vector<float>& shareNorth) {
    float most = 0;
    for (int y0 = 0; y0 + stride < down; y0 += stride) {
        for (int x0 = 0; x0 + stride < samples.across; x0 += stride) {
            const float southWest = samples.at(x0, y0);
            const float southEast = samples.at(x0 + stride, y0);
            const float northWest = samples.at(x0, y0 + stride);
            const float northEast = samples.at(x0 + stride, y0 + stride);
            const bool rising = (x0 / stride + y0 / stride) % 2 == 0;
            for (int y = 0; y <= stride; ++y) {
                const float v = y == stride ? 1 : shareNorth[static_cast<std::size_t>(y0 + y)];
                for (int x = 0; x <= stride; ++x) {
                    const float u = x == stride ? 1 : shareEast[static_cast<std::size_t>(x0 + x)];
                    float between = 0;
                    if (rising) {
                        between = u >= v ? southWest + u * (southEast - southWest) + v * (northEast - southEast)
                                         : southWest + v * (northWest - southWest) + u * (northEast - northWest);
                    } else {
                        between = u + v <= 1 ? southWest + u * (southEast - southWest) + v * (northWest - southWest)
                                             : northEast + (1 - u) * (northWest - northEast) +
                                                   (1 - v) * (southEast - northEast);
                    }
                    most = std::max(most, std::abs(between - samples.at(x0 + x, y0 + y)));
                }
            }
        }
    }
    return most;
}

}  // namespace

int coarsestLevel(int columns, int rows, double toolRadius) {
    int level = 0;
    while (level + 1 < kLevels && (std::max(columns, rows) >> (level + 1)) >= kKeptCells &&
           (toolRadius <= 0 || 2 << (level + 1) <= toolRadius)) {
        ++level;
    }
    return level;
}

LevelErrors errorsOf(const SandSurface& surface, const sand::Rect& vertices, const glm::vec3& sun, int coarsest) {
    const int across = vertices.x1 - vertices.x0;
    const int down = vertices.y1 - vertices.y0;
    Samples heights{{}, across};
    Samples light{{}, across};
    std::vector<float> east, north;
    for (int column = vertices.x0; column < vertices.x1; ++column) {
        east.push_back(surface.east(column));
    }
    for (int row = vertices.y0; row < vertices.y1; ++row) {
        north.push_back(surface.north(row));
        for (int column = vertices.x0; column < vertices.x1; ++column) {
            const glm::vec2 slope = surface.slope(column, row);
            heights.values.push_back(surface.height(column - 1, row - 1));
            light.values.push_back(std::max(0.0F, (sun.z - slope.x * sun.x - slope.y * sun.y) /
                                                      std::sqrt(1 + slope.x * slope.x + slope.y * slope.y)));
        }
    }
    LevelErrors errors;
    for (int level = 1; level <= coarsest; ++level) {
        const int stride = 1 << level;
        const std::vector<float> shareEast = sharesOf(east, stride);
        const std::vector<float> shareNorth = sharesOf(north, stride);
        const auto at = static_cast<std::size_t>(level);
        errors.height[at] = distance(heights, down, stride, shareEast, shareNorth);
        errors.light[at] = distance(light, down, stride, shareEast, shareNorth);
    }
    return errors;
}

LevelRule::LevelRule(const glm::dmat4& sceneToClip, glm::ivec2 size, double bound)
    : sceneToClip_(sceneToClip), half_(glm::dvec2(size) / 2.0), bound_(bound) {}

/// How many pixels the picture of a point moves at most when the point moves up by a unit. The tiles of a plane give
/// the same: their clip coordinates differ in scale, which the number of pixels makes up for, and in a share of w,
/// which falls out of the difference below.
double LevelRule::pixelsPerUnit(const Box& box) const {
    double nearest = std::numeric_limits<double>::infinity();
    glm::dvec2 most(0);
    const glm::dvec4 up = sceneToClip_[2];
    for (const glm::dvec3& corner : cornersOf(box)) {
        const glm::dvec4 clip = sceneToClip_ * glm::dvec4(corner, 1);
        nearest = std::min(nearest, clip.w);
        most = glm::max(most, glm::abs(glm::dvec2(up) * clip.w - glm::dvec2(clip) * up.w));
    }
    return nearest <= 0 ? std::numeric_limits<double>::infinity() : glm::length(half_ * most) / (nearest * nearest);
}

int LevelRule::level(const Box& box, const LevelErrors& errors, int coarsest) const {
    if (bound_ <= 0 || coarsest == 0) {
        return 0;
    }
    const double height = bound_ / pixelsPerUnit(box);
    const double light = bound_ * kLightPerPixel;
    int level = coarsest;
    while (level > 0 && (double{errors.height[static_cast<std::size_t>(level)]} > height ||
                         double{errors.light[static_cast<std::size_t>(level)]} > light)) {
        --level;
    }
    return level;
}

}  // namespace render_node
