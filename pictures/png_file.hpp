// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "pictures/image.hpp"

namespace pictures {

/// Reads any PNG as RGB8. Transparent pixels are laid over black, and 16-bit channels become 8-bit. Throws
/// base::InputError, which names the file, if it is missing, incomplete, not a PNG, or larger than kMaxPixels. It also
/// throws if the file claims more pixels than its bytes can hold.
[[nodiscard]] Image readPng(const std::filesystem::path& file);

/// Writes the image. Removes the file if writing fails, and throws base::InputError, which names the file.
void writePng(const std::filesystem::path& file, const Image& image);

}  // namespace pictures
