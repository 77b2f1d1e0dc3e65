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
enum Type : std::uint8_t { kFrame = 1, kEnd, kTicks, kResumed, kMaterial, kContinued, kDoubt, kChecked, kForce };
constexpr std::uint8_t kBeginsWrite = 0x80;  // added to the type of the first record of a write

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

JournalDoubt getDoubt(base::ByteReader& reader) {
    JournalDoubt doubt;
    doubt.frame = reader.getVarint();
    doubt.sand = getEnd(reader);
    return doubt;
}

JournalChecked getChecked(base::ByteReader& reader) {
    JournalChecked checked;
    checked.frame = reader.getVarint();
    checked.sand = getEnd(reader);
    checked.outvoted = reader.get<std::uint8_t>() != 0;
    return checked;
}

JournalForce getForce(base::ByteReader& reader) {
    const JournalForce force{reader.get<double>()};
    if (!(force.share >= 0 && force.share <= 1)) {
        throw base::FormatError("a share of the force outside 0 to 1");
    }
    return force;
}

/// Writes type and payload of a record, with its mark if it is the first of a write.
struct Encode {
    std::optional<std::uint64_t> synced;
    base::ByteWriter writer{};

    void begin(Type type) {
        writer.put(static_cast<std::uint8_t>(type | (synced ? kBeginsWrite : 0)));
        if (synced) {
            writer.put(*synced);
        }
    }

    void operator()(const JournalFrame& frame) {
        begin(kFrame);
        writer.putVarint(frame.frame);
        writer.put(frame.hashBefore);
        writer.putVarint(frame.steps.size());
        for (const sand::Step& step : frame.steps) {
            sand::encode(step, writer);
        }
    }
    void operator()(const JournalEnd& end) {
        begin(kEnd);
        put(end, writer);
    }
    void operator()(const JournalTicks& ticks) {
        begin(kTicks);
        writer.putBytes(ticks.piece);
    }
    void operator()(const JournalResumed& resumed) {
        begin(kResumed);
        writer.putVarint(resumed.frame);
        put(resumed.sand, writer);
        writer.put(resumed.cutBytes);
        writer.putText(resumed.failure);
    }
    void operator()(const scene::Material& material) {
        begin(kMaterial);
        put(material, writer);
    }
    void operator()(const JournalContinued& continued) {
        begin(kContinued);
        writer.put(continued.part);
    }
    void operator()(const JournalDoubt& doubt) {
        begin(kDoubt);
        writer.putVarint(doubt.frame);
        put(doubt.sand, writer);
    }
    void operator()(const JournalChecked& checked) {
        begin(kChecked);
        writer.putVarint(checked.frame);
        put(checked.sand, writer);
        writer.put(static_cast<std::uint8_t>(checked.outvoted ? 1 : 0));
    }
    void operator()(const JournalForce& force) {
        begin(kForce);
        writer.put(force.share);
    }
};

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

base::Bytes encodeRecord(const JournalRecord& record, std::uint64_t& chain, std::optional<std::uint64_t> synced) {
    Encode encode{synced};
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
    if ((body[0] & kBeginsWrite) != 0) {
        (void)payload.get<std::uint64_t>();
    }
    const auto type = static_cast<std::uint8_t>(body[0] & ~kBeginsWrite);
    switch (type) {
        case kFrame:
            return getFrame(payload);
        case kEnd:
            return getEnd(payload);
        case kTicks:
            return JournalTicks{{payload.rest().begin(), payload.rest().end()}};
        case kResumed:
            return getResumed(payload);
        case kMaterial:
            return getMaterial(payload);
        case kContinued:
            return JournalContinued{payload.get<std::uint32_t>()};
        case kDoubt:
            return getDoubt(payload);
        case kChecked:
            return getChecked(payload);
        case kForce:
            return getForce(payload);
        default:
            throw base::FormatError(fmt::format("a record of unknown type {}", type));
    }
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

/// Returns whether a whole record begins with `record`. `chain` is the checksum before it.
bool isWhole(std::span<const std::uint8_t> record, std::uint64_t chain) {
    std::uint32_t length = 0;
    std::memcpy(&length, record.data(), sizeof length);
    if (length > record.size() - kAroundPayload) {
        return false;
    }
    const auto body = record.subspan(sizeof length, std::size_t{length} + 1);
    std::uint64_t said = 0;
    std::memcpy(&said, body.data() + body.size(), sizeof said);
    return said == chainedSum(body, chain);
}

}  // namespace

bool holdsLaterWrite(std::span<const std::uint8_t> rest, std::uint64_t offset) {
    constexpr std::size_t kLength = sizeof(std::uint32_t);
    constexpr std::size_t kLeast = kAroundPayload + sizeof(std::uint64_t);
    constexpr std::uint64_t kLongestPart = std::uint64_t{1} << 40;  // [byte], of --journal-part
    for (std::size_t at = 1; at + kLeast <= rest.size(); ++at) {
        const std::uint8_t type = rest[at + kLength];
        const auto mark =
            type > kBeginsWrite && type <= (kBeginsWrite | kForce) ? markOf(rest.subspan(at + kLength)) : std::nullopt;
        // A mark is the place of its own record. That is enough, because its checksum cannot be verified if the bytes
        // before it are lost.
        if (mark == offset + at) {
            return true;
        }
        // Bytes before it may have been removed or added, so that the record has moved.
        std::uint64_t before = 0;
        if (mark && *mark < kLongestPart && at >= sizeof before) {
            std::memcpy(&before, &rest[at - sizeof before], sizeof before);
            if (isWhole(rest.subspan(at), before)) {
                return true;
            }
        }
    }
    return false;
}

}  // namespace master
