// SPDX-License-Identifier: Apache-2.0
#include "walls/wall_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "walls/projection.hpp"

namespace walls {
namespace {

std::array<glm::dvec3, 4> cornersOf(const Screen& s) {
    return {s.lowerLeft, s.lowerRight, s.upperRight(), s.upperLeft};
}

/// Returns the screen without a rim of kTouch, but at least its middle half.
Screen inner(const Screen& s) {
    const double rimX = std::min(kTouch, s.width() / 4), rimY = std::min(kTouch, s.height() / 4);
    Screen result;
    result.lowerLeft = s.lowerLeft + s.right() * rimX + s.up() * rimY;
    result.lowerRight = s.lowerRight - s.right() * rimX + s.up() * rimY;
    result.upperLeft = s.upperLeft + s.right() * rimX - s.up() * rimY;
    return result;
}

/// Returns whether the projections of two rectangles onto a direction are separate.
bool apart(const std::array<glm::dvec3, 4>& a, const std::array<glm::dvec3, 4>& b, glm::dvec3 along) {
    const auto reach = [&](const std::array<glm::dvec3, 4>& corners) {
        std::array<double, 4> shadows{};
        std::transform(corners.begin(), corners.end(), shadows.begin(),
                       [&](glm::dvec3 corner) { return glm::dot(corner, along); });
        const auto [low, high] = std::minmax_element(shadows.begin(), shadows.end());
        return std::pair(*low, *high);
    };
    const auto [lowA, highA] = reach(a);
    const auto [lowB, highB] = reach(b);
    return highA < lowB || highB < lowA;
}

}  // namespace

bool isTileName(std::string_view name) {
    return !name.empty() && name.size() <= 32 && std::all_of(name.begin(), name.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    });
}

bool isOneLine(std::string_view text, std::size_t longest) {
    return text.size() <= longest &&
           std::none_of(text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; });
}

double pixelShape(const Tile& tile) {
    return (tile.screen.width() / tile.pixels.x) / (tile.screen.height() / tile.pixels.y);
}

double rightPixelShape(Stereo stereo, const Tile& tile) {
    return !isStretched(stereo, tile) ? 1 : stereo == Stereo::sideBySide ? 2 : 0.5;
}

std::optional<std::string> pixelFault(Stereo stereo, const Tile& tile) {
    const glm::ivec2 frame = outputPixels(stereo, tile.pixels);
    if (std::max(frame.x, frame.y) > kMaxTileSide) {
        return fmt::format("both eyes of tile '{}' in one frame would be {}x{} pixels; a side has at most {}",
                           tile.name, frame.x, frame.y, kMaxTileSide);
    }
    if (std::abs(pixelShape(tile) / rightPixelShape(stereo, tile) - 1) <= kShapeTolerance) {
        return std::nullopt;
    }
    const char* halves =
        stereo == Stereo::sideBySide  ? " (or twice as wide as high, where the display stretches halves)"
        : stereo == Stereo::topBottom ? " (or twice as high as wide, where the display stretches halves)"
                                      : "";
    return fmt::format(
        "pixels of tile '{}' would be {:.4g} x {:.4g} mm; they must be square within 1 %{}: check metres "
        "against pixels",
        tile.name, tile.screen.width() / tile.pixels.x * 1000, tile.screen.height() / tile.pixels.y * 1000, halves);
}

std::optional<std::string> eyeFault(const Wall& wall, const Tile& tile) {
    for (const Eye eye : eyesOf(wall.stereo)) {
        const glm::dvec3 at = eyePosition(wall.viewer, eye);
        if (!(tile.screen.distanceTo(at) >= kMinEyeDistance)) {
            return fmt::format(
                "the {} eye at ({:.3f}, {:.3f}, {:.3f}) is not in front of tile '{}': move [viewer] eye, "
                "or give the corners as the viewer sees them",
                eyeName(eye), at.x, at.y, at.z, tile.name);
        }
    }
    return std::nullopt;
}

std::optional<std::string> viewerFault(const Wall& wall) {
    // A screen at the viewer's side, as in a CAVE, is at right angles to the viewer's `right`. It is in order.
    const auto faces = [&](const Tile& tile) { return glm::dot(wall.viewer.right, tile.screen.right()) > -0.1; };
    if (eyesOf(wall.stereo).size() < 2 || std::any_of(wall.tiles.begin(), wall.tiles.end(), faces)) {
        return std::nullopt;
    }
    const glm::dvec3 right = wall.tiles.front().screen.right();
    return fmt::format(
        "the viewer's right eye is left of the left one on every tile: write right = [{:.6g}, {:.6g}, "
        "{:.6g}] in [viewer]",
        right.x, right.y, right.z);
}

std::optional<std::string> viewFault(const Wall& wall) {
    for (const Tile& tile : wall.tiles) {
        if (auto fault = pixelFault(wall.stereo, tile)) {
            return fault;
        }
        if (auto fault = eyeFault(wall, tile)) {
            return fault;
        }
    }
    return viewerFault(wall);
}

// Two flat convex figures are apart exactly if a direction separates them. It is enough to try the normals of both
// figures and all cross products of two edges. In one plane it is enough to try the edges' normals.
Contact contactOf(const Screen& first, const Screen& second) {
    const Screen innerA = inner(first), innerB = inner(second);
    const auto a = cornersOf(innerA), b = cornersOf(innerB);
    const std::array<glm::dvec3, 2> edgesA{first.right(), first.up()}, edgesB{second.right(), second.up()};
    const bool parallel = std::abs(glm::dot(first.normal(), second.normal())) > 1 - 1e-5;  // 0.26 degrees
    if (parallel) {
        const double between = std::abs(glm::dot(first.normal(), (b[0] + b[2]) / 2.0 - first.lowerLeft));
        const auto parts = [&](glm::dvec3 along) { return apart(a, b, along); };
        return between > kTouch || std::any_of(edgesA.begin(), edgesA.end(), parts) ||
                       std::any_of(edgesB.begin(), edgesB.end(), parts)
                   ? Contact::none
                   : Contact::overlapping;
    }
    if (apart(a, b, first.normal()) || apart(a, b, second.normal())) {
        return Contact::none;
    }
    for (const glm::dvec3 edgeA : edgesA) {
        for (const glm::dvec3 edgeB : edgesB) {
            const glm::dvec3 along = glm::cross(edgeA, edgeB);
            if (glm::length(along) > 1e-9 && apart(a, b, glm::normalize(along))) {
                return Contact::none;
            }
        }
    }
    return Contact::crossing;
}

}  // namespace walls
