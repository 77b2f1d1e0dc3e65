// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "pictures/compare.hpp"
#include "pictures/image.hpp"

/// Golden pictures: pictures of an earlier version. Pictures of this version must equal them.
namespace golden {

// Largest number of pixels of a golden picture. It is small because the repository contains the pictures.
inline constexpr int kMostPixels = 45000;

/// Returns the folder of the golden pictures of one kind.
[[nodiscard]] std::filesystem::path folder(const std::string& kind);

/// Returns the folder for pictures that do not pass.
[[nodiscard]] std::filesystem::path failures();

/// Returns whether a picture is blank or broken. A blank picture has one colour, a broken one a few.
[[nodiscard]] bool isBlank(const pictures::Image& image);

/// Returns why `got` does not equal `expected`, or an empty text if it does. Both have one size. `tool` marks the
/// pixels that may show the tool or its shadow. These pixels are also compared separately, because they are too few to
/// count in the whole picture. An empty mask means a picture without a tool.
[[nodiscard]] std::string fault(const pictures::Image& expected, const pictures::Image& got,
                                const pictures::Mask& tool);

/// Fails the test unless `got` equals the golden picture `name`.png of the folder. Writes got, want and diff. With
/// SANDWALL_WRITE_GOLDENS=1, writes `got` as the golden picture and fails the test too.
void expect(const std::filesystem::path& folder, const std::string& name, const pictures::Image& got,
            const pictures::Mask& tool = {});

}  // namespace golden
