// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

namespace host {

/// File that is written completely or not at all. keep() replaces the previous file at its path.
///
/// The text goes into a temporary file in the same folder. keep() renames it; without keep() the destructor removes it.
/// A path that is not a plain file, such as a pipe, is written to directly. Throws base::InputError in one line if the
/// path cannot be written. To test whether a path can be written, create a WholeFile and destroy it.
class WholeFile {
public:
    explicit WholeFile(const std::filesystem::path& path);
    ~WholeFile();
    WholeFile(const WholeFile&) = delete;
    WholeFile& operator=(const WholeFile&) = delete;

    [[nodiscard]] std::ostream& stream() { return stream_; }
    void keep();
    /// Does what keep() does, and returns when the file is on disk, where it survives a power loss.
    void keepSynced();

private:
    [[noreturn]] void fail() const;

    std::filesystem::path path_;    // as the user gave it
    std::filesystem::path target_;  // `path_` with links resolved
    std::filesystem::path beside_;  // temporary file; empty if target_ is written to directly
    std::ofstream stream_;
};

/// Syncs the folder of `file`, so that created and removed names survive a power loss. Some file systems cannot do it.
void syncFolderOf(const std::filesystem::path& file);

}  // namespace host
