// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <vector>

namespace scene {

/// Points [x, y, z] of a survey, in the order of the file, no place twice [file's length unit].
using Points = std::vector<std::array<double, 3>>;

/// Reads lines of x, y and z, separated by a comma, a semicolon, or blanks; # begins a comment, and the first line may
/// be a title, which holds no number. Points that the file says twice come once.
///
/// Throws base::InputError with file, line and value: what is no finite number, a title that speaks of degrees, more
/// or fewer than three of them, two heights at one place, fewer than three points, all of them on one line, more than
/// kMostPoints.
[[nodiscard]] Points readPoints(const std::filesystem::path& file);

inline constexpr std::size_t kMostPoints = 50'000'000;  // 2.4 GB while they are read

}  // namespace scene
