// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "host/regular_file.hpp"
#include "journal/journal_parts.hpp"

namespace master {

/// Returns the name of a part: FILE, FILE.2, FILE.3 …
[[nodiscard]] std::filesystem::path partOf(const std::filesystem::path& journal, std::uint32_t part);

/// The parts of a journal in files. Each must be a regular file, and no link is followed to it. Keeps the file open
/// that it has read last.
class FileParts : public journal::JournalParts {
public:
    explicit FileParts(std::filesystem::path journal) : journal_(std::move(journal)) {}

    [[nodiscard]] std::string name(std::uint32_t part) const override { return partOf(journal_, part).string(); }
    /// Returns whether anything has the name of the part. Only length() opens it, and says why if it cannot.
    [[nodiscard]] bool has(std::uint32_t part) const override;
    [[nodiscard]] std::int64_t length(std::uint32_t part) override;
    void read(std::uint32_t part, std::int64_t offset, std::int64_t size, base::Bytes& bytes) override;

private:
    void open(std::uint32_t part);

    std::filesystem::path journal_;            // the first part
    std::unique_ptr<host::RegularFile> file_;  // nullptr: none
    std::uint32_t opened_ = 0;                 // the part of file_; 0: none
    base::Bytes ahead_;                        // a piece of file_, because records are short and read one after another
    std::int64_t aheadAt_ = 0;                 // place of ahead_ [byte]
};

}  // namespace master
