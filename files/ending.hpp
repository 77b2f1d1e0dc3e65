// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "files/lower_case.hpp"

namespace files {

/// How a file's name ends, ".tif" of "A.TIF": small letters, for some systems write large ones. Empty without a dot.
[[nodiscard]] inline std::string endingOf(const std::filesystem::path& file) {
    return lowerCase(file.extension().string());
}

}  // namespace files
