// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

namespace host {

/// A file that is written whole or not at all: what stood at its path is replaced by keep() and not before.
///
/// The text goes into a file beside it, which is renamed at the end, and removed when keep() is not reached. A path
/// that is no plain file, such as a pipe, is written to directly. Throws base::InputError in one line when the path
/// cannot be written; making one and letting it go is a test of that which changes nothing.
class WholeFile {
public:
    explicit WholeFile(const std::filesystem::path& path);
    ~WholeFile();
    WholeFile(const WholeFile&) = delete;
    WholeFile& operator=(const WholeFile&) = delete;

    [[nodiscard]] std::ostream& stream() { return stream_; }
    void keep();
    /// As keep(), and on the disk when it returns: also after a loss of power.
    void keepSynced();

private:
    [[noreturn]] void fail() const;

    std::filesystem::path path_;    // as it was given
    std::filesystem::path target_;  // behind links
    std::filesystem::path beside_;  // empty where target_ is written to directly
    std::ofstream stream_;
};

/// Names that were given or taken in this file's folder are on the disk when it returns, where folders can be synced.
void syncFolderOf(const std::filesystem::path& file);

}  // namespace host
