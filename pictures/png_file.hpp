// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "pictures/image.hpp"

namespace pictures {

/// Reads any PNG as RGB8; transparency is laid over black, 16 bits become 8.
/// Throws base::InputError naming the file when it is missing, not a whole PNG, larger than kMaxPixels, or claims
/// more pixels than its bytes can hold.
[[nodiscard]] Image readPng(const std::filesystem::path& file);

/// Writes the image; nothing is left behind when that fails. Throws base::InputError naming the file.
void writePng(const std::filesystem::path& file, const Image& image);

}  // namespace pictures
