// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <string>

namespace host {

/// Returns the number at the start of a file of the kernel, or nullopt if it starts with a word such as "max".
[[nodiscard]] inline std::optional<std::int64_t> numberIn(const std::filesystem::path& file) {
    std::ifstream stream(file);
    std::int64_t number = 0;
    return stream >> number ? std::optional(number) : std::nullopt;
}

/// Returns the number behind a key of a file of the kernel that has a key in each line, or nullopt without the key.
[[nodiscard]] inline std::optional<std::int64_t> numberOf(const std::string& wanted,
                                                          const std::filesystem::path& file) {
    std::ifstream stream(file);
    std::string key;
    while (stream >> key) {
        std::int64_t number = 0;
        if (key == wanted && stream >> number) {
            return number;
        }
        stream.clear();
        stream.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
    }
    return std::nullopt;
}

}  // namespace host
