// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "journal/format.hpp"
#include "journal/journal_parts.hpp"

namespace journal {

/// Place behind a whole record, at which a session can continue.
struct JournalPlace {
    std::string journal;  // name of the journal's first part
    std::uint64_t session = 0;
    std::uint32_t part = 1;
    std::int64_t offset = 0;  // in that part [byte]
    std::uint64_t chain = 0;
    std::int64_t seen = 0;  // length of that part when it was read [byte]
};

/// Reads a session record by record, from part to part. Holds one record at a time. Used by one thread.
class JournalReader {
public:
    /// Throws base::InputError if the first part is missing, is not a journal, is a later part, has another format or
    /// algorithm, or has a damaged header. `release` is that of this program.
    JournalReader(std::unique_ptr<JournalParts> parts, std::string_view release);
    /// Makes a reader of the same journal that begins again behind the header of its first part. It shares the header,
    /// which has the scene. `opened` must not have returned a record yet. Throws base::InputError if the first part is
    /// shorter now.
    JournalReader(std::unique_ptr<JournalParts> parts, const JournalReader& opened);

    [[nodiscard]] const JournalHeader& header() const { return *header_; }
    /// Returns the next record; nullopt behind the last whole one. At the end of a part it continues with the next part
    /// and does not return the JournalContinued.
    ///
    /// Throws base::InputError with the place if the journal is damaged before its end, or if one of its parts is
    /// missing. All records that it has returned before are intact.
    [[nodiscard]] std::optional<JournalRecord> next();

    /// Returns the place behind the record that next() has returned last.
    [[nodiscard]] const JournalPlace& place() const { return place_; }
    /// Returns the number of bytes behind the last whole record. Valid after next() has returned nullopt.
    [[nodiscard]] std::int64_t tornBytes() const { return tornBytes_; }
    [[nodiscard]] std::uint32_t parts() const { return place_.part; }
    /// Returns the length of all parts so far up to place(), with headers [byte].
    [[nodiscard]] std::int64_t wholeBytes() const { return earlierBytes_ + place_.offset; }

private:
    void open(std::uint32_t part);
    void openNext(std::uint32_t part);
    [[nodiscard]] JournalHeader readHeader(std::uint32_t part, std::int64_t size, std::uint64_t& chain,
                                           std::int64_t& length);
    [[nodiscard]] bool readRecord(base::Bytes& body);
    [[noreturn]] void fail(const std::string& why) const;
    void endHere(const std::string& why);
    /// Sets JournalFrame::doubted of a record that has been read.
    void followDoubt(JournalRecord& record);
    /// Throws base::FormatError if a step of `record` is one that no step of this sand can be.
    void requireWithinLimits(const JournalRecord& record) const;
    /// Returns whether there is a next part of this session with a record.
    [[nodiscard]] bool continues();
    /// Returns the name of a part without the folder before it.
    [[nodiscard]] std::string shortName(std::uint32_t part) const;

    std::unique_ptr<JournalParts> parts_;
    std::string release_;
    std::shared_ptr<const JournalHeader> header_;  // of the part that is read
    sand::StepLimits limits_;                      // of the scene, which only the first part has
    JournalPlace place_;
    std::int64_t size_ = 0;  // [byte], length of the part
    std::int64_t earlierBytes_ = 0;
    std::int64_t tornBytes_ = 0;
    bool ended_ = false;
    bool doubted_ = false;  // the hashes of the next frames do not count
};

}  // namespace journal
