// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "pictures/compare.hpp"
#include "pictures/image.hpp"

/// Golden pictures: pictures of an earlier version, which those of this version must equal.
namespace golden {

inline constexpr int kMostPixels = 45000;  // of one picture, because the repository holds them

/// Returns the folder of the golden pictures of one kind.
[[nodiscard]] std::filesystem::path folder(const std::string& kind);

/// Returns the folder for pictures that do not pass.
[[nodiscard]] std::filesystem::path failures();

/// Returns whether there is nothing to see: a blank picture has one colour, a broken one a few.
[[nodiscard]] bool isBlank(const pictures::Image& image);

/// Returns why `got` does not pass for `want`, or nothing if it passes. Both have one size. `tool` marks the pixels
/// that may show the tool or its shadow. They are held by themselves too, because they are too few to count in the
/// whole picture. An empty mask stands for a picture without a tool.
[[nodiscard]] std::string fault(const pictures::Image& want, const pictures::Image& got, const pictures::Mask& tool);

/// Fails the test unless `got` passes for the golden picture `name`.png of the folder; leaves got, want and diff.
/// With SANDWALL_WRITE_GOLDENS=1, writes `got` as the golden picture and fails the test as well.
void expect(const std::filesystem::path& folder, const std::string& name, const pictures::Image& got,
            const pictures::Mask& tool = {});

}  // namespace golden
