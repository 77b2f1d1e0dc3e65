// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "pictures/image.hpp"

/// Pictures that are compared with those of before.
namespace golden {

inline constexpr int kMostPixels = 45000;  // of one, for the sake of the repository

/// Where those of one kind lie.
[[nodiscard]] std::filesystem::path folder(const std::string& kind);

/// Whether there is nothing to see: a blank picture has a colour, a broken one a few.
[[nodiscard]] bool isBlank(const pictures::Image& image);

/// Fails the test when the picture is not the golden one; leaves got, and want and what differs where there is one.
/// With SANDWALL_WRITE_GOLDENS=1 it becomes the golden one.
void expect(const std::string& kind, const std::string& name, const pictures::Image& got);

}  // namespace golden
