// SPDX-License-Identifier: Apache-2.0
#include "scene/import/steady_files.hpp"

#include <fmt/format.h>

#include <optional>
#include <system_error>

namespace scene {
namespace {

std::optional<std::uintmax_t> sizeOf(const std::filesystem::path& file) {
    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(file, error);
    return error ? std::nullopt : std::optional(bytes);
}

}  // namespace

SteadyFiles::SteadyFiles(const std::vector<std::filesystem::path>& files) {
    for (const std::filesystem::path& file : files) {
        std::error_code none;
        if (const auto bytes = sizeOf(file); bytes && std::filesystem::is_regular_file(file, none)) {
            files_.push_back({file, *bytes});
        }
    }
}

void SteadyFiles::requireUnchanged() const {
    for (const File& file : files_) {
        // A file that is gone or replaced can still be read to its end.
        if (const auto bytes = sizeOf(file.path); bytes && *bytes != file.bytes) {
            throw base::InputError(fmt::format(
                "{}: has changed while it was read: it had {} bytes, and has {} now; wait until the program that "
                "writes it has ended, and start again",
                file.path.string(), file.bytes, *bytes));
        }
    }
}

}  // namespace scene
