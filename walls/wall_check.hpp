// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "walls/wall.hpp"

/// What must hold of every wall, wherever it comes from. Pure functions, safe from any thread.
namespace walls {

inline constexpr double kMaxEyeSeparation = 0.5;              // [m]
inline constexpr double kMinEyeDistance = 0.01;               // [m], nearer than this a frustum has no sensible shape
inline constexpr double kMinRefresh = 1, kMaxRefresh = 1000;  // [Hz]
inline constexpr double kShapeTolerance = 0.01;               // of a pixel's width against its height
// Corners measured by tape cross by millimetres where screens only touch.
inline constexpr double kTouch = 0.005;  // [m]
inline constexpr std::size_t kMaxTracking = 200;

/// Names become parts of file names: 1 to 32 letters, digits, '_' or '-'.
[[nodiscard]] bool isTileName(std::string_view name);
/// Short, and without control characters: fit to be printed in a line of its own.
[[nodiscard]] bool isOneLine(std::string_view text, std::size_t longest);

/// Width against height of one pixel of an eye's picture.
[[nodiscard]] double pixelShape(const Tile& tile);
/// What pixelShape should be: 1; where the display stretches halves of a frame (isStretched), 2 or 1/2.
[[nodiscard]] double rightPixelShape(Stereo stereo, const Tile& tile);

/// What is wrong with the shape of a tile's pixels; nothing when all is well.
[[nodiscard]] std::optional<std::string> pixelFault(Stereo stereo, const Tile& tile);
/// The first drawn eye that is not kMinEyeDistance before the tile: behind it, or the corners are mirrored.
[[nodiscard]] std::optional<std::string> eyeFault(const Wall& wall, const Tile& tile);
/// Eyes that are swapped on every tile: the viewer's `right` points the wrong way.
[[nodiscard]] std::optional<std::string> viewerFault(const Wall& wall);
/// The first of the above that a wall has: what a wall shown in another mode must be asked again.
[[nodiscard]] std::optional<std::string> viewFault(const Wall& wall);

/// How the lit rectangles of two tiles lie to each other.
enum class Contact : std::uint8_t { none, overlapping, crossing };
/// Rectangles that meet by no more than kTouch do not: overlapping ones share area in one plane, crossing ones pass
/// through each other.
[[nodiscard]] Contact contactOf(const Screen& a, const Screen& b);

}  // namespace walls
