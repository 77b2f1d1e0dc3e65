// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <vector>

namespace scene {

/// Points [x, y, z] of a survey, in the order of the file, each place once [file's length unit].
using Points = std::vector<std::array<double, 3>>;

/// Reads lines of x, y and z, separated by a comma, a semicolon, or blanks. Numbers may have decimal commas unless a
/// comma separates them. # begins a comment. The first line may be a title, which holds no number. If it names
/// northing, easting and height, or the like, the columns may have any order. A point that the file repeats is returned
/// once.
///
/// `done` is called with the part of the work that is done, 0 to 1, and must not throw. It may be empty.
///
/// Throws base::InputError with file, line and value for:
/// - a file whose size changes while it is read,
/// - a value that is not a finite number, a title with degrees or with x, y and z in another order, a line without
/// exactly three values,
/// - two heights at one place, fewer than three points, points that all lie on one line,
/// - more than kMostPoints points.
[[nodiscard]] Points readPoints(const std::filesystem::path& file, const std::function<void(double share)>& done = {});

inline constexpr std::size_t kMostPoints = 50'000'000;  // reading so many points takes 2.4 GB

}  // namespace scene
