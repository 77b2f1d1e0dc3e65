// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>

#include "master/journal/format.hpp"

namespace master {

/// FILE, FILE.2, FILE.3 …
[[nodiscard]] std::filesystem::path partOf(const std::filesystem::path& journal, std::uint32_t part);

/// Behind a whole record: where a session can go on.
struct JournalPlace {
    std::filesystem::path journal;  // its first part
    std::uint64_t session = 0;
    std::uint32_t part = 1;
    std::int64_t offset = 0;  // in that part [byte]
    std::uint64_t chain = 0;
    std::int64_t seen = 0;  // how long that part was when it was read [byte]
};

/// Reads a session record by record, from part to part. Holds one record at a time. One thread.
class JournalReader {
public:
    /// Throws base::InputError if the file is missing, is not a journal, is a later part, has another format or
    /// algorithm, or has a damaged header.
    explicit JournalReader(std::filesystem::path journal);

    [[nodiscard]] const JournalHeader& header() const { return header_; }
    /// The next record; nothing behind the last whole one. Never JournalContinued: what follows comes from the next
    /// part. Throws base::InputError, with the place, for a journal that is damaged before its end, and for one of
    /// whose parts one is missing; what was given before is whole.
    [[nodiscard]] std::optional<JournalRecord> next();

    /// Behind the record that was given last.
    [[nodiscard]] const JournalPlace& place() const { return place_; }
    /// At the end, behind the last whole record, once next() has given nothing.
    [[nodiscard]] std::int64_t tornBytes() const { return tornBytes_; }
    [[nodiscard]] std::uint32_t parts() const { return place_.part; }
    /// Of all parts so far, headers and all.
    [[nodiscard]] std::int64_t wholeBytes() const { return earlierBytes_ + place_.offset; }
    /// Of all parts that are there.
    [[nodiscard]] std::int64_t allBytes() const;

private:
    void open(std::uint32_t part);
    void openNext(std::uint32_t part);
    [[nodiscard]] bool readRecord(base::Bytes& body);
    [[noreturn]] void fail(const std::string& why) const;
    void endHere(const std::string& why);
    /// Whether there is a next part that holds anything.
    [[nodiscard]] bool goesOn() const;

    JournalHeader header_;
    JournalPlace place_;
    std::ifstream stream_;
    std::int64_t size_ = 0;  // of the part [byte]
    std::int64_t earlierBytes_ = 0;
    std::int64_t tornBytes_ = 0;
    bool ended_ = false;
};

}  // namespace master
