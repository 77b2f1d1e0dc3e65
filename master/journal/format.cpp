// SPDX-License-Identifier: Apache-2.0
#include "master/journal/format.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <cstring>
#include <type_traits>

namespace master {
namespace {

constexpr std::uint32_t kJournalMagic = 0x4c4a5753;  // "SWJL"
constexpr FileKind kJournalKind{.name = "journal", .magic = kJournalMagic, .format = kJournalVersion, .firstFormat = 6};
enum Type : std::uint8_t { kFrame = 1, kEnd, kTicks, kResumed, kMaterial, kContinued };

std::uint64_t chainedSum(std::span<const std::uint8_t> bytes, std::uint64_t seed) {
    return XXH3_64bits_withSeed(bytes.data(), bytes.size(), seed);  // with seed 0 the same as XXH3_64bits()
}

void put(const JournalEnd& end, base::ByteWriter& writer) {
    writer.put(end.step);
    writer.put(end.hash);
}

JournalEnd getEnd(base::ByteReader& reader) {
    JournalEnd end;
    end.step = reader.get<std::uint64_t>();
    end.hash = reader.get<std::uint64_t>();
    return end;
}

void put(const scene::Material& material, base::ByteWriter& writer) {
    for (const double number : {material.dryTalus, material.humidity, material.cohesionLength, material.band,
                                material.settlingSeconds, material.toolRadius, material.toolHeading}) {
        writer.put(number);
    }
    for (const std::optional<double>& number : {material.wetTalus, material.toolWidth}) {
        writer.put(static_cast<std::uint8_t>(number ? 1 : 0));
        writer.put(number.value_or(0));
    }
    writer.put(static_cast<std::uint8_t>(material.toolKind));
    writer.put(static_cast<std::uint8_t>(material.leftFoot ? 1 : 0));
}

scene::Material getMaterial(base::ByteReader& reader) {
    scene::Material material;
    for (double* number : {&material.dryTalus, &material.humidity, &material.cohesionLength, &material.band,
                           &material.settlingSeconds, &material.toolRadius, &material.toolHeading}) {
        *number = reader.get<double>();
    }
    for (std::optional<double>* number : {&material.wetTalus, &material.toolWidth}) {
        const bool there = reader.get<std::uint8_t>() != 0;
        const auto value = reader.get<double>();
        *number = there ? std::optional(value) : std::nullopt;
    }
    const auto kind = reader.get<std::uint8_t>();
    if (kind >= sand::kToolKinds) {
        throw base::FormatError("a material with a tool of an unknown shape");
    }
    material.toolKind = static_cast<sand::ToolKind>(kind);
    material.leftFoot = reader.get<std::uint8_t>() != 0;
    return material;
}

JournalFrame getFrame(base::ByteReader& reader) {
    JournalFrame frame;
    frame.frame = reader.getVarint();
    frame.hashBefore = reader.get<std::uint64_t>();
    const std::uint64_t count = reader.getVarint();
    for (std::uint64_t i = 0; i < count; ++i) {
        frame.steps.push_back(sand::decodeStep(reader));
    }
    return frame;
}

JournalResumed getResumed(base::ByteReader& reader) {
    JournalResumed resumed;
    resumed.frame = reader.getVarint();
    resumed.sand = getEnd(reader);
    resumed.cutBytes = reader.get<std::int64_t>();
    resumed.failure = reader.getText();
    return resumed;
}

/// Writes type and payload of a record.
struct Encode {
    base::ByteWriter writer{};

    void operator()(const JournalFrame& frame) {
        writer.put(std::uint8_t{kFrame});
        writer.putVarint(frame.frame);
        writer.put(frame.hashBefore);
        writer.putVarint(frame.steps.size());
        for (const sand::Step& step : frame.steps) {
            sand::encode(step, writer);
        }
    }
    void operator()(const JournalEnd& end) {
        writer.put(std::uint8_t{kEnd});
        put(end, writer);
    }
    void operator()(const JournalTicks& ticks) {
        writer.put(std::uint8_t{kTicks});
        writer.putBytes(ticks.piece);
    }
    void operator()(const JournalResumed& resumed) {
        writer.put(std::uint8_t{kResumed});
        writer.putVarint(resumed.frame);
        put(resumed.sand, writer);
        writer.put(resumed.cutBytes);
        writer.putText(resumed.failure);
    }
    void operator()(const scene::Material& material) {
        writer.put(std::uint8_t{kMaterial});
        put(material, writer);
    }
    void operator()(const JournalContinued& continued) {
        writer.put(std::uint8_t{kContinued});
        writer.put(continued.part);
    }
};

/// Returns whether a record, a part of one, zeros or the end of the file may begin at `at`. Looks at one byte only.
bool mayFollow(std::span<const std::uint8_t> rest, std::size_t at) {
    constexpr std::size_t kLength = sizeof(std::uint32_t);
    return rest.size() - at <= kLength || rest[at + kLength] <= kContinued;
}

/// Returns whether a whole record begins at `at`. `chain` is the checksum before it.
bool recordAt(std::span<const std::uint8_t> rest, std::size_t at, std::uint64_t chain) {
    std::uint32_t length = 0;
    if (at > rest.size() || rest.size() - at < kAroundPayload) {
        return false;
    }
    std::memcpy(&length, &rest[at], sizeof length);
    const std::uint8_t type = rest[at + sizeof length];
    if (length > rest.size() - at - kAroundPayload || type < kFrame || type > kContinued) {
        return false;
    }
    if (!mayFollow(rest, at + kAroundPayload + length)) {  // without this, checksums at every byte take minutes
        return false;
    }
    const auto body = rest.subspan(at + sizeof length, std::size_t{length} + 1);
    std::uint64_t said = 0;
    std::memcpy(&said, body.data() + body.size(), sizeof said);
    return said == chainedSum(body, chain);
}

}  // namespace

base::Bytes encodeHeader(const JournalHeader& header, std::uint64_t& chain) {
    base::ByteWriter writer;
    writeOrigin(kJournalKind, writer);
    writer.put(header.part);
    for (const std::uint64_t number : {header.session, header.continues, header.sand.step, header.sand.hash}) {
        writer.put(number);
    }
    writer.putText(header.buildId);
    writer.putBlock(header.scene);
    base::ByteWriter material;
    if (header.material) {
        put(*header.material, material);
    }
    writer.putBlock(material.bytes());
    chain = chainedSum(writer.bytes(), header.continues);
    writer.put(chain);
    return writer.take();
}

namespace {

/// Decodes what follows the origin.
void decodeRest(JournalHeader& header, base::ByteReader& reader, std::span<const std::uint8_t> all,
                std::uint64_t& chain) {
    header.part = reader.get<std::uint32_t>();
    header.session = reader.get<std::uint64_t>();
    header.continues = reader.get<std::uint64_t>();
    header.sand = getEnd(reader);
    header.buildId = reader.getText();
    const auto scene = reader.getBlock();
    const auto material = reader.getBlock();
    const std::size_t checked = all.size() - reader.rest().size();
    chain = reader.get<std::uint64_t>();
    if (chain != chainedSum(all.first(checked), header.continues)) {
        throw base::FormatError("its checksum is wrong");
    }
    header.scene.assign(scene.begin(), scene.end());
    if (!material.empty()) {
        base::ByteReader numbers(material);
        header.material = getMaterial(numbers);
    }
}

}  // namespace

JournalHeader decodeHeader(base::ByteReader& reader, std::uint64_t& chain) {
    const std::span<const std::uint8_t> all = reader.rest();
    JournalHeader header;
    try {
        header.origin = readOrigin(kJournalKind, reader);
        decodeRest(header, reader, all, chain);
    } catch (const ForeignFile&) {
        throw;
    } catch (const base::FormatError& error) {
        throw HeaderLost(fmt::format("its header is cut off or damaged ({})", error.what()));
    }
    return header;
}

base::Bytes encodeRecord(const JournalRecord& record, std::uint64_t& chain) {
    Encode encode;
    std::visit(encode, record);
    const base::Bytes& body = encode.writer.bytes();
    base::ByteWriter writer;
    writer.put(static_cast<std::uint32_t>(body.size() - 1));
    writer.putBytes(body);
    chain = chainedSum(body, chain);
    writer.put(chain);
    return writer.take();
}

JournalRecord decodeRecord(std::span<const std::uint8_t> body) {
    base::ByteReader payload(body.subspan(1));
    switch (body[0]) {
        case kFrame:
            return getFrame(payload);
        case kEnd:
            return getEnd(payload);
        case kTicks:
            return JournalTicks{{body.begin() + 1, body.end()}};
        case kResumed:
            return getResumed(payload);
        case kMaterial:
            return getMaterial(payload);
        case kContinued:
            return JournalContinued{payload.get<std::uint32_t>()};
        default:
            throw base::FormatError(fmt::format("a record of unknown type {}", body[0]));
    }
}

std::uint64_t recordChecksum(std::span<const std::uint8_t> body, std::uint64_t chain) {
    return chainedSum(body, chain);
}

bool holdsRecords(std::span<const std::uint8_t> rest, std::uint64_t chain) {
    if (rest.size() >= kAroundPayload) {
        // If only this record's stored checksum is wrong, the next record continues from the right checksum.
        std::uint32_t length = 0;
        std::memcpy(&length, rest.data(), sizeof length);
        if (length <= rest.size() - kAroundPayload) {
            const auto body = rest.subspan(sizeof length, std::size_t{length} + 1);
            if (recordAt(rest, length + kAroundPayload, chainedSum(body, chain))) {
                return true;
            }
        }
    }
    std::uint64_t before = 0;
    for (std::size_t at = sizeof before; at + kAroundPayload <= rest.size(); ++at) {
        std::memcpy(&before, &rest[at - sizeof before], sizeof before);
        if (recordAt(rest, at, before)) {
            return true;
        }
    }
    return false;
}

}  // namespace master
