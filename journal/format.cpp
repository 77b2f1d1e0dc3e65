// SPDX-License-Identifier: Apache-2.0
#include "journal/format.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <cstring>
#include <type_traits>

namespace journal {
namespace {

constexpr std::uint32_t kJournalMagic = 0x4c4a5753;  // "SWJL"
constexpr FileKind kJournalKind{.name = "journal", .magic = kJournalMagic, .format = kJournalVersion, .firstFormat = 6};
constexpr std::uint8_t kBeginsWrite = 0x80;  // added to the type of the first record of a write

std::uint64_t chainedSum(std::span<const std::uint8_t> bytes, std::uint64_t seed) {
    return XXH3_64bits_withSeed(bytes.data(), bytes.size(), seed);  // with seed 0 the same as XXH3_64bits()
}

/// Names of the records, in the order of JournalRecord.
constexpr std::array<std::string_view, std::variant_size_v<JournalRecord>> kRecords{
    "a record of a frame",      "a record of an end",     "a record of ticks",
    "a record of a resumption", "a record of a material", "a record of a continuation",
    "a record of a doubt",      "a record of a check",    "a record of a force"};

}  // namespace

base::Bytes encodeHeader(const JournalHeader& header, std::string_view release, std::uint64_t& chain) {
    base::ByteWriter writer;
    writeOrigin(kJournalKind, release, writer);
    base::putMember(writer, header);
    chain = chainedSum(writer.bytes(), header.continues);
    writer.put(chain);
    return writer.take();
}

JournalHeader decodeHeader(base::ByteReader& reader, std::string_view release, std::uint64_t& chain) {
    const std::span<const std::uint8_t> all = reader.rest();
    JournalHeader header;
    try {
        header.origin = readOrigin(kJournalKind, release, reader);
        base::getMember(reader, header);
        const std::size_t checked = all.size() - reader.rest().size();
        chain = base::read<std::uint64_t>(reader);
        if (chain != chainedSum(all.first(checked), header.continues)) {
            throw base::FormatError("its checksum is wrong");
        }
    } catch (const ForeignFile&) {
        throw;
    } catch (const base::FormatError& error) {
        throw HeaderLost(fmt::format("its header is cut off or damaged ({})", error.what()));
    }
    return header;
}

base::Bytes encodeRecord(const JournalRecord& record, std::uint64_t& chain, std::optional<std::uint64_t> synced) {
    base::ByteWriter body;
    body.put(static_cast<std::uint8_t>((record.index() + 1) | (synced ? kBeginsWrite : 0U)));
    if (synced) {
        body.put(*synced);
    }
    std::visit([&body](const auto& kind) { base::putMember(body, kind); }, record);
    base::ByteWriter writer;
    writer.put(static_cast<std::uint32_t>(body.bytes().size() - 1));
    writer.putBytes(body.bytes());
    chain = chainedSum(body.bytes(), chain);
    writer.put(chain);
    return writer.take();
}

JournalRecord decodeRecord(std::span<const std::uint8_t> body) {
    base::ByteReader payload(body.subspan(1));
    if ((body[0] & kBeginsWrite) != 0) {
        (void)payload.get<std::uint64_t>();
    }
    const auto type = static_cast<std::uint8_t>(body[0] & ~kBeginsWrite);
    if (type < 1 || type > kRecords.size()) {
        throw base::FormatError(fmt::format("a record of unknown type {}", type));
    }
    return base::readAlternative<JournalRecord>(type - 1U, payload, kRecords);
}

std::uint64_t recordChecksum(std::span<const std::uint8_t> body, std::uint64_t chain) {
    return chainedSum(body, chain);
}

std::optional<std::uint64_t> markOf(std::span<const std::uint8_t> body) {
    std::uint64_t mark = 0;
    if (body.size() <= sizeof mark || (body[0] & kBeginsWrite) == 0) {
        return std::nullopt;
    }
    std::memcpy(&mark, &body[1], sizeof mark);
    return mark;
}

namespace {

/// Returns the length of the type and payload of a record that begins with `record` [byte], or 0 if it does not fit.
std::size_t lengthOfBody(std::span<const std::uint8_t> record) {
    std::uint32_t length = 0;
    std::memcpy(&length, record.data(), sizeof length);
    return length > record.size() - kAroundPayload ? 0 : std::size_t{length} + 1;
}

/// Returns whether the checksum behind a body of `length` bytes is right. `chain` is the checksum before the record.
bool isWhole(std::span<const std::uint8_t> record, std::size_t length, std::uint64_t chain) {
    const auto body = record.subspan(sizeof(std::uint32_t), length);
    std::uint64_t stored = 0;
    std::memcpy(&stored, body.data() + body.size(), sizeof stored);
    return stored == chainedSum(body, chain);
}

}  // namespace

LaterWrite searchLaterWrite(std::span<const std::uint8_t> rest, std::uint64_t offset) {
    constexpr std::size_t kLength = sizeof(std::uint32_t);
    constexpr std::size_t kLeast = kAroundPayload + sizeof(std::uint64_t);
    constexpr std::uint64_t kLongestPart = std::uint64_t{1} << 40;  // [byte], of --journal-part
    LaterWrite search;
    for (std::size_t at = 1; at + kLeast <= rest.size(); ++at) {
        const std::uint8_t type = rest[at + kLength];
        const auto mark = type > kBeginsWrite && type <= (kBeginsWrite | std::variant_size_v<JournalRecord>)
                              ? markOf(rest.subspan(at + kLength))
                              : std::nullopt;
        // A mark is the place of its own record. That is enough, because its checksum cannot be verified if the bytes
        // before it are lost.
        if (mark == offset + at) {
            search.found = true;
            return search;
        }
        // Bytes before it may have been removed or added, so that the record has moved.
        std::uint64_t before = 0;
        if (!mark || *mark >= kLongestPart || at < sizeof before) {
            continue;
        }
        const std::size_t length = lengthOfBody(rest.subspan(at));
        if (length == 0 || search.hashed + length > kMostHashesOfTail * rest.size()) {
            continue;
        }
        search.hashed += length;
        std::memcpy(&before, &rest[at - sizeof before], sizeof before);
        if (isWhole(rest.subspan(at), length, before)) {
            search.found = true;
            return search;
        }
    }
    return search;
}

}  // namespace journal
