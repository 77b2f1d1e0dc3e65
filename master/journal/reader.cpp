// SPDX-License-Identifier: Apache-2.0
#include "master/journal/reader.hpp"

#include <fmt/format.h>

#include <array>
#include <cstring>
#include <utility>

#include "base/input_error.hpp"

namespace master {
namespace {

namespace fs = std::filesystem;

std::span<std::uint8_t> readInto(std::ifstream& stream, base::Bytes& bytes, std::int64_t size) {
    bytes.resize(static_cast<std::size_t>(size));
    stream.read(reinterpret_cast<char*>(bytes.data()), size);
    bytes.resize(static_cast<std::size_t>(stream.gcount()));
    stream.clear();
    return bytes;
}

/// Reads the header of a file and sets `length` to its length [byte]. Throws base::FormatError.
JournalHeader readHeader(std::ifstream& stream, std::int64_t size, std::uint64_t& chain, std::int64_t& length) {
    // The header's length is known only after the header has been read. Nearly all of it is the scene.
    for (std::int64_t piece = 1 << 16;; piece *= 8) {
        base::Bytes bytes;
        stream.seekg(0);
        base::ByteReader reader(readInto(stream, bytes, std::min(piece, size)));
        try {
            JournalHeader header = decodeHeader(reader, chain);
            length = static_cast<std::int64_t>(bytes.size() - reader.rest().size());
            return header;
        } catch (const HeaderLost&) {
            if (piece >= size) {
                throw;
            }
        }
    }
}

}  // namespace

fs::path partOf(const fs::path& journal, std::uint32_t part) {
    return part == 1 ? journal : fs::path(fmt::format("{}.{}", journal.string(), part));
}

JournalReader::JournalReader(fs::path journal) {
    place_.journal = std::move(journal);
    try {
        open(1);
        if (header_.part == 1) {  // a later part holds no scene
            sweeps_ = scene::Scene::decodeRules(header_.scene).sweepRange();
        }
    } catch (const HeaderLost& error) {
        fail(fmt::format("{}; it holds the scene as the session began, without which nothing can be recovered",
                         error.what()));
    } catch (const base::FormatError& error) {
        throw base::InputError(fmt::format("{}: {}", place_.journal.string(), error.what()));
    }
    if (header_.part != 1) {
        fail(fmt::format("is part {} of a session; name its first part", header_.part));
    }
}

void JournalReader::open(std::uint32_t part) {
    const fs::path file = partOf(place_.journal, part);
    std::error_code none;
    stream_.close();
    // Opening a pipe would wait until a process writes to it.
    if (fs::is_fifo(file, none)) {
        throw base::InputError(fmt::format("{}: cannot be read; it is not a plain file", file.string()));
    }
    stream_.open(file, std::ios::binary);
    if (!stream_ || fs::is_directory(file, none)) {
        throw base::InputError(fmt::format("{}: cannot be read; check the path", file.string()));
    }
    stream_.seekg(0, std::ios::end);
    size_ = stream_.tellg();
    if (size_ < 0) {
        throw base::InputError(fmt::format("{}: cannot be read; it is not a plain file", file.string()));
    }
    if (size_ == 0) {
        throw base::FormatError("is empty");
    }
    header_ = readHeader(stream_, size_, place_.chain, place_.offset);
    place_.session = header_.session;
    place_.part = part;
    place_.seen = size_;
    stream_.seekg(place_.offset);
}

void JournalReader::openNext(std::uint32_t part) {
    const JournalPlace before = place_;
    const fs::path file = partOf(place_.journal, part);
    std::error_code none;
    if (part != before.part + 1 || !fs::exists(file, none)) {
        fail(fmt::format("continues in {}, which is missing; everything before is intact", file.filename().string()));
    }
    try {
        open(part);
    } catch (const base::FormatError& error) {
        throw base::InputError(fmt::format("{}: {}; the part before is intact", file.string(), error.what()));
    }
    earlierBytes_ += before.offset;
    if (header_.session != before.session || header_.part != part || header_.continues != before.chain) {
        throw base::InputError(fmt::format("{}: does not continue {}; everything before is intact", file.string(),
                                           partOf(before.journal, before.part).filename().string()));
    }
}

void JournalReader::fail(const std::string& why) const {
    throw base::InputError(fmt::format("{}: {}", partOf(place_.journal, place_.part).string(), why));
}

bool JournalReader::continues() const {
    const fs::path file = partOf(place_.journal, place_.part + 1);
    std::error_code none;
    std::ifstream next;
    if (fs::is_regular_file(file, none)) {
        next.open(file, std::ios::binary | std::ios::ate);
    }
    if (!next.is_open()) {
        return false;
    }
    try {
        const std::int64_t size = next.tellg();
        std::uint64_t chain = 0;
        std::int64_t length = 0;
        const JournalHeader header = readHeader(next, size, chain, length);
        // A part that was made but not continued has only a header.
        return header.session == header_.session && size > length;
    } catch (const base::FormatError&) {
        return false;
    }
}

bool JournalReader::readRecord(base::Bytes& body) {
    std::array<char, sizeof(std::uint32_t)> four{};
    if (size_ - place_.offset < static_cast<std::int64_t>(kAroundPayload) || !stream_.read(four.data(), four.size())) {
        return false;
    }
    std::uint32_t length = 0;
    std::memcpy(&length, four.data(), sizeof length);
    if (length > size_ - place_.offset - static_cast<std::int64_t>(kAroundPayload)) {
        return false;
    }
    std::uint64_t stored = 0;
    const std::size_t wanted = std::size_t{length} + 1 + sizeof stored;
    if (readInto(stream_, body, static_cast<std::int64_t>(wanted)).size() != wanted) {
        return false;
    }
    std::memcpy(&stored, body.data() + body.size() - sizeof stored, sizeof stored);
    body.resize(body.size() - sizeof stored);
    if (recordChecksum(body, place_.chain) != stored) {
        return false;
    }
    if (const auto mark = markOf(body); mark && *mark != static_cast<std::uint64_t>(place_.offset)) {
        return false;
    }
    place_.chain = stored;
    return true;
}

void JournalReader::endHere(const std::string& why) {
    const std::int64_t left = size_ - place_.offset;
    if (left > 0) {
        base::Bytes rest;
        stream_.clear();
        stream_.seekg(place_.offset);
        // A crash tears only the last write. If a write follows, this record had been on disk and was damaged there.
        if (holdsLaterWrite(readInto(stream_, rest, left), static_cast<std::uint64_t>(place_.offset))) {
            fail(fmt::format("damaged at byte {} of {}: {}; everything before is intact", place_.offset, size_, why));
        }
    }
    if (continues()) {
        fail(fmt::format(
            "cut off at byte {}, but {} continues the session after missing records; everything before is intact",
            place_.offset, partOf(place_.journal, place_.part + 1).filename().string()));
    }
    tornBytes_ = left;
    ended_ = true;
}

void JournalReader::followDoubt(JournalRecord& record) {
    if (std::holds_alternative<JournalDoubt>(record)) {
        doubted_ = true;
    } else if (std::holds_alternative<JournalChecked>(record) || std::holds_alternative<JournalResumed>(record)) {
        doubted_ = false;
    } else if (auto* frame = std::get_if<JournalFrame>(&record)) {
        frame->doubted = doubted_;
    }
}

void JournalReader::requireSweeps(const JournalRecord& record) const {
    if (const auto* frame = std::get_if<JournalFrame>(&record)) {
        for (const sand::Step& step : frame->steps) {
            if (const std::string why = step.refusal(sweeps_); !why.empty()) {
                throw base::FormatError(why);
            }
        }
    }
}

std::optional<JournalRecord> JournalReader::next() {
    base::Bytes body;
    while (!ended_) {
        if (!readRecord(body)) {
            endHere("an incomplete record");
            break;
        }
        JournalRecord record;
        try {
            record = decodeRecord(body);
            requireSweeps(record);
        } catch (const base::FormatError& error) {
            fail(fmt::format("damaged at byte {} of {}: {}; everything before is intact", place_.offset, size_,
                             error.what()));
        }
        place_.offset += static_cast<std::int64_t>(body.size() - 1 + kAroundPayload);
        if (const auto* continued = std::get_if<JournalContinued>(&record)) {
            openNext(continued->part);
            continue;
        }
        followDoubt(record);
        return record;
    }
    return std::nullopt;
}

std::int64_t JournalReader::allBytes() const {
    std::int64_t sum = 0;
    std::error_code error;
    for (std::uint32_t part = 1;; ++part) {
        const auto size = fs::file_size(partOf(place_.journal, part), error);
        if (error) {
            return sum;
        }
        sum += static_cast<std::int64_t>(size);
    }
}

}  // namespace master
