// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "walls/wall.hpp"

/// Checks that every wall must pass, from any source. All functions are pure. Any thread may call them.
namespace walls {

inline constexpr double kMaxEyeSeparation = 0.5;  // [m]
inline constexpr double kMinEyeDistance = 0.01;   // [m]; at a smaller distance the frustum has no sensible shape
inline constexpr double kMinRefresh = 1, kMaxRefresh = 1000;  // [Hz]
inline constexpr double kShapeTolerance = 0.01;  // largest error of the ratio of a pixel's width to its height
// Corners that were measured by tape may overlap by millimetres although the screens only touch.
inline constexpr double kTouch = 0.005;  // [m]
inline constexpr std::size_t kMaxTracking = 200;

/// Returns whether a name fits a tile: 1 to 32 letters, digits, '_' or '-'. It becomes part of file names.
[[nodiscard]] bool isTileName(std::string_view name);
/// Returns whether a text can be printed on one line: at most `longest` bytes, without control characters.
[[nodiscard]] bool isOneLine(std::string_view text, std::size_t longest);

/// Returns the ratio of width to height of one pixel of an eye's picture.
[[nodiscard]] double pixelShape(const Tile& tile);
/// Returns the right value for pixelShape(): 1, or 2 or 1/2 if the display stretches halves of a frame (isStretched()).
[[nodiscard]] double rightPixelShape(Stereo stereo, const Tile& tile);

/// Returns the fault in the shape of a tile's pixels, or nullopt.
[[nodiscard]] std::optional<std::string> pixelFault(Stereo stereo, const Tile& tile);
/// Returns the fault of the first drawn eye that is not at least kMinEyeDistance in front of the tile, or nullopt. Such
/// an eye is behind the tile, or the tile's corners are mirrored.
[[nodiscard]] std::optional<std::string> eyeFault(const Wall& wall, const Tile& tile);
/// Returns the fault that the eyes are swapped on every tile, or nullopt. In that case the viewer's `right` points the
/// wrong way.
[[nodiscard]] std::optional<std::string> viewerFault(const Wall& wall);
/// Returns the first fault that the functions above find in a wall, or nullopt. Must be called again if the wall is
/// shown in another mode.
[[nodiscard]] std::optional<std::string> viewFault(const Wall& wall);

/// Contact between the lit rectangles of two tiles.
enum class Contact : std::uint8_t { none, overlapping, crossing };
/// Returns the contact between two rectangles. Overlapping rectangles share area in one plane. Crossing rectangles pass
/// through each other. Contact of at most kTouch does not count.
[[nodiscard]] Contact contactOf(const Screen& a, const Screen& b);

}  // namespace walls
