// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "base/input_error.hpp"

namespace scene {

/// Sizes of files from before they are read, because another program may write to a file meanwhile. GDAL takes the
/// heights behind the new end of some files for 0, and a text that is cut within its last number lacks nothing.
class SteadyFiles {
public:
    SteadyFiles() = default;
    /// Notes the sizes. Files that are not regular files have none, and are never refused.
    explicit SteadyFiles(const std::vector<std::filesystem::path>& files);

    /// Throws base::InputError if a file has another size now.
    void requireUnchanged() const;
    /// Returns what `read` returns. If a file has another size then, throws base::InputError that says so, in place of
    /// the result or of the base::InputError of `read`.
    template <class Read>
    auto read(Read read) const {
        try {
            auto result = read();
            requireUnchanged();
            return result;
        } catch (const base::InputError&) {
            requireUnchanged();
            throw;
        }
    }

private:
    struct File {
        std::filesystem::path path;
        std::uintmax_t bytes = 0;
    };
    std::vector<File> files_;
};

}  // namespace scene
