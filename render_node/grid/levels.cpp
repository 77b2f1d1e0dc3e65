// SPDX-License-Identifier: Apache-2.0
#include "render_node/grid/levels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace render_node {
namespace {

// Range of the change of shade by mottling, as in shaders/sunlit.glsl.
constexpr float kDarkest = 0.86F;
constexpr float kMottling = 0.28F;

/// Samples with which the interpolation over a level's triangles is compared.
struct Samples {
    std::vector<float> values;  // row by row
    int across;

    [[nodiscard]] float at(int x, int y) const {
        return values[static_cast<std::size_t>(y) * static_cast<std::size_t>(across) + static_cast<std::size_t>(x)];
    }
};

/// Returns for each vertex its place between two vertices of the level, 0 … 1. The outermost vertices of a field are
/// closer together.
std::vector<float> sharesOf(const std::vector<float>& places, int stride) {
    std::vector<float> shares;
    for (int i = 0; i + 1 < static_cast<int>(places.size()); ++i) {
        const auto first = static_cast<std::size_t>(i / stride * stride);
        const float length = places[first + static_cast<std::size_t>(stride)] - places[first];
        shares.push_back(length > 0 ? (places[static_cast<std::size_t>(i)] - places[first]) / length : 0.0F);
    }
    return shares;
}

/// Returns the largest distance of the samples of one quad from the quad's two triangles. Leaves out the north and east
/// sides, which other quads or other chunks measure. The stride is a template parameter because the compiler then makes
/// faster code.
template <int kStride>
float distanceInQuad(const Samples& samples, glm::ivec2 at, const float* shareEast, const float* shareNorth) {
    const float southWest = samples.at(at.x, at.y);
    const float east = samples.at(at.x + kStride, at.y) - southWest;
    const float north = samples.at(at.x, at.y + kStride) - southWest;
    const float twist = samples.at(at.x + kStride, at.y + kStride) - southWest - east - north;
    const bool rising = (at.x / kStride + at.y / kStride) % 2 == 0;
    float most = 0;
    for (int y = 0; y < kStride; ++y) {
        const float v = shareNorth[at.y + y];
        const float* row = &samples.values[static_cast<std::size_t>((at.y + y) * samples.across + at.x)];
        for (int x = 0; x < kStride; ++x) {
            const float u = shareEast[at.x + x];
            const float beyond = rising ? std::min(u, v) : std::max(u + v - 1, 0.0F);
            const float between = southWest + u * east + v * north + beyond * twist;
            most = std::max(most, std::abs(between - row[x]));
        }
    }
    return most;
}

template <int kStride>
float distance(const Samples& samples, const std::vector<float>& shareEast, const std::vector<float>& shareNorth) {
    float most = 0;
    for (int y = 0; y < static_cast<int>(shareNorth.size()); y += kStride) {
        for (int x = 0; x < static_cast<int>(shareEast.size()); x += kStride) {
            most = std::max(most, distanceInQuad<kStride>(samples, {x, y}, shareEast.data(), shareNorth.data()));
        }
    }
    return most;
}

}  // namespace

LevelErrors errorsOf(const shapes::GridVertices& surface, const sand::CellRect& vertices, const glm::vec3& sun,
                     int finest, int coarsest) {
    const int step = 1 << finest;
    const int across = (vertices.x1 - vertices.x0 - 1) / step + 1;
    const int down = (vertices.y1 - vertices.y0 - 1) / step + 1;
    const std::size_t all = static_cast<std::size_t>(across) * static_cast<std::size_t>(down);
    Samples heights{std::vector<float>(all), across};
    Samples light{std::vector<float>(all), across};
    std::vector<float> east, north;
    for (int column = vertices.x0; column < vertices.x1; column += step) {
        east.push_back(surface.east(column));
    }
    std::size_t next = 0;
    for (int row = vertices.y0; row < vertices.y1; row += step) {
        north.push_back(surface.north(row));
        for (int column = vertices.x0; column < vertices.x1; column += step) {
            const glm::vec2 slope = surface.slope(column, row);
            heights.values[next] = surface.height(column - 1, row - 1);
            const float towards = sun.z - slope.x * sun.x - slope.y * sun.y;
            const float lit = std::max(0.0F, towards / std::sqrt(1 + slope.x * slope.x + slope.y * slope.y));
            light.values[next++] = lit * (kDarkest + kMottling * surface.mottling(column, row));
        }
    }
    LevelErrors errors;
    constexpr std::array kDistances{distance<1>, distance<2>, distance<4>, distance<8>, distance<16>};
    static_assert(kDistances.size() == shapes::kLevels);
    for (int level = finest + 1; level <= coarsest; ++level) {
        const int stride = 1 << (level - finest);  // [sample]
        const auto distance = kDistances[static_cast<std::size_t>(level - finest)];
        const std::vector<float> shareEast = sharesOf(east, stride);
        const std::vector<float> shareNorth = sharesOf(north, stride);
        errors.height[static_cast<std::size_t>(level)] = distance(heights, shareEast, shareNorth);
        errors.light[static_cast<std::size_t>(level)] = distance(light, shareEast, shareNorth);
    }
    return errors;
}

}  // namespace render_node
