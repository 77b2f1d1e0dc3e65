// SPDX-License-Identifier: Apache-2.0
#include "journal/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "base/input_error.hpp"

namespace journal {

JournalReader::JournalReader(std::unique_ptr<JournalParts> parts, std::string_view release)
    : parts_(std::move(parts)), release_(release) {
    place_.journal = parts_->name(1);
    try {
        open(1);
        if (header_->part == 1) {  // a later part holds no scene
            limits_ = scene::Scene::decodeRules(header_->scene).stepLimits();
        }
    } catch (const HeaderLost& error) {
        fail(fmt::format("{}; it holds the scene as the session began, without which nothing can be recovered",
                         error.what()));
    } catch (const base::FormatError& error) {
        throw base::InputError(fmt::format("{}: {}", place_.journal, error.what()));
    }
    if (header_->part != 1) {
        fail(fmt::format("is part {} of a session; name its first part", header_->part));
    }
}

JournalReader::JournalReader(std::unique_ptr<JournalParts> parts, const JournalReader& opened)
    : parts_(std::move(parts)),
      release_(opened.release_),
      header_(opened.header_),
      limits_(opened.limits_),
      place_(opened.place_),
      size_(parts_->length(1)) {
    if (header_->part != 1 || size_ < place_.offset) {
        throw base::InputError(fmt::format("{}: has changed since it was opened", place_.journal));
    }
    place_.seen = size_;
}

/// Reads the header of a part and sets `length` to its length [byte]. Throws base::FormatError.
JournalHeader JournalReader::readHeader(std::uint32_t part, std::int64_t size, std::uint64_t& chain,
                                        std::int64_t& length) {
    // The header's length is known only after the header has been read. Nearly all of it is the scene.
    for (std::int64_t piece = 1 << 16;; piece *= 8) {
        base::Bytes bytes;
        parts_->read(part, 0, std::min(piece, size), bytes);
        base::ByteReader reader(bytes);
        try {
            JournalHeader header = decodeHeader(reader, release_, chain);
            length = static_cast<std::int64_t>(bytes.size() - reader.rest().size());
            return header;
        } catch (const HeaderLost&) {
            if (piece >= size) {
                throw;
            }
        }
    }
}

std::string JournalReader::shortName(std::uint32_t part) const {
    const std::string name = parts_->name(part);
    return name.substr(name.rfind('/') + 1);
}

void JournalReader::open(std::uint32_t part) {
    size_ = parts_->length(part);
    if (size_ == 0) {
        throw base::FormatError("is empty");
    }
    header_ = std::make_shared<const JournalHeader>(readHeader(part, size_, place_.chain, place_.offset));
    place_.session = header_->session;
    place_.part = part;
    place_.seen = size_;
}

void JournalReader::openNext(std::uint32_t part) {
    const JournalPlace before = place_;
    if (part != before.part + 1 || !parts_->has(part)) {
        fail(fmt::format("continues in {}, which is missing; everything before is intact", shortName(part)));
    }
    try {
        open(part);
    } catch (const base::FormatError& error) {
        throw base::InputError(fmt::format("{}: {}; the part before is intact", parts_->name(part), error.what()));
    }
    earlierBytes_ += before.offset;
    if (header_->session != before.session || header_->part != part || header_->continues != before.chain) {
        throw base::InputError(fmt::format("{}: does not continue {}; everything before is intact", parts_->name(part),
                                           shortName(before.part)));
    }
}

void JournalReader::fail(const std::string& why) const {
    throw base::InputError(fmt::format("{}: {}", parts_->name(place_.part), why));
}

bool JournalReader::continues() {
    const std::uint32_t part = place_.part + 1;
    if (!parts_->has(part)) {
        return false;
    }
    try {
        const std::int64_t size = parts_->length(part);
        std::uint64_t chain = 0;
        std::int64_t length = 0;
        const JournalHeader header = readHeader(part, size, chain, length);
        // A part that was made but not continued has only a header.
        return header.session == header_->session && size > length;
    } catch (const base::FormatError&) {
        return false;
    } catch (const base::InputError&) {
        return false;
    }
}

bool JournalReader::readRecord(base::Bytes& body) {
    std::uint32_t length = 0;
    if (size_ - place_.offset < static_cast<std::int64_t>(kAroundPayload)) {
        return false;
    }
    parts_->read(place_.part, place_.offset, sizeof length, body);
    if (body.size() != sizeof length) {
        return false;
    }
    std::memcpy(&length, body.data(), sizeof length);
    if (length > size_ - place_.offset - static_cast<std::int64_t>(kAroundPayload)) {
        return false;
    }
    std::uint64_t stored = 0;
    const std::size_t wanted = std::size_t{length} + 1 + sizeof stored;
    parts_->read(place_.part, place_.offset + static_cast<std::int64_t>(sizeof length),
                 static_cast<std::int64_t>(wanted), body);
    if (body.size() != wanted) {
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
        parts_->read(place_.part, place_.offset, left, rest);
        // A crash tears only the last write. If a write follows, this record had been on disk and was damaged there.
        if (searchLaterWrite(rest, static_cast<std::uint64_t>(place_.offset)).found) {
            fail(fmt::format("damaged at byte {} of {}: {}; everything before is intact", place_.offset, size_, why));
        }
    }
    if (continues()) {
        fail(fmt::format(
            "cut off at byte {}, but {} continues the session after missing records; everything before is intact",
            place_.offset, shortName(place_.part + 1)));
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

void JournalReader::requireWithinLimits(const JournalRecord& record) const {
    if (const auto* frame = std::get_if<JournalFrame>(&record)) {
        for (const sand::Step& step : frame->steps) {
            if (const std::string why = step.refusal(limits_); !why.empty()) {
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
            requireWithinLimits(record);
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

}  // namespace journal
