// SPDX-License-Identifier: Apache-2.0
#include "master/journal.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <utility>

#include "files/input_error.hpp"

namespace master {
namespace {

constexpr std::uint32_t kMagic = 0x4c4a5753;  // "SWJL"
constexpr std::uint32_t kVersion = 4;
// 1 knew settle alone of the edits; 2 no tune and no load; 3 only spheres, and no ticks.
constexpr std::uint32_t kOldestVersion = 1;
constexpr std::uint8_t kFrameRecord = 1;
constexpr std::uint8_t kEndRecord = 2;
constexpr std::uint8_t kTicksRecord = 3;
constexpr std::size_t kMostWaiting = 1 << 20;  // [byte] of ticks, while no step is made

std::uint64_t checksum(std::span<const std::uint8_t> bytes) { return XXH3_64bits(bytes.data(), bytes.size()); }

files::Bytes headerOf(const sand::Scene& scene, const std::string& buildId) {
    files::ByteWriter writer;
    writer.put(kMagic);
    writer.put(kVersion);
    writer.putText(buildId);
    writer.putBlock(scene.encode());
    writer.put(checksum(writer.bytes()));
    return writer.take();
}

JournalFrame decodeFrame(files::ByteReader& reader) {
    JournalFrame frame;
    frame.frame = reader.getVarint();
    frame.hashBefore = reader.get<std::uint64_t>();
    const std::uint64_t count = reader.getVarint();
    for (std::uint64_t i = 0; i < count; ++i) {
        frame.steps.push_back(sand::decodeStep(reader));
    }
    return frame;
}

/// Reads one record into the journal. Throws files::FormatError when it is not whole.
void readRecord(files::ByteReader& reader, Journal& journal) {
    const auto length = reader.get<std::uint32_t>();
    const auto body = reader.getBytes(std::size_t{length} + 1);  // type and payload
    if (reader.get<std::uint64_t>() != checksum(body)) {
        throw files::FormatError("a record whose checksum is wrong");
    }
    files::ByteReader payload(body.subspan(1));
    if (body[0] == kFrameRecord) {
        journal.frames.push_back(decodeFrame(payload));
    } else if (body[0] == kEndRecord) {
        JournalEnd& end = journal.end.emplace();
        end.step = payload.get<std::uint64_t>();
        end.hash = payload.get<std::uint64_t>();
    } else if (body[0] == kTicksRecord) {
        journal.ticks.emplace_back(body.begin() + 1, body.end());
    } else {
        throw files::FormatError(fmt::format("a record of unknown type {}", body[0]));
    }
}

/// Whether whole records stand anywhere behind the first byte.
bool holdsRecords(std::span<const std::uint8_t> rest) {
    std::uint32_t length = 0;
    constexpr std::size_t kAround = sizeof length + 1 + sizeof(std::uint64_t);  // length, type, checksum
    for (std::size_t at = 1; at + kAround <= rest.size(); ++at) {
        std::memcpy(&length, &rest[at], sizeof length);
        const std::uint8_t type = rest[at + sizeof length];
        if (length > rest.size() - at - kAround || type < kFrameRecord || type > kTicksRecord) {
            continue;
        }
        const std::span<const std::uint8_t> body = rest.subspan(at + sizeof length, std::size_t{length} + 1);
        std::uint64_t said = 0;
        std::memcpy(&said, body.data() + body.size(), sizeof said);
        if (said == checksum(body)) {
            return true;
        }
    }
    return false;
}

}  // namespace

JournalWriter::JournalWriter(const std::filesystem::path& file, const sand::Scene& scene, const std::string& buildId)
    : file_(file) {
    std::error_code none;  // usually there is no older one
    if (std::filesystem::is_regular_file(file, none)) {
        std::filesystem::rename(file, file.string() + ".previous", none);
    }
    descriptor_ = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (descriptor_ < 0) {
        throw files::InputError(
            fmt::format("{}: cannot be made ({}); choose another --out", file.string(), std::strerror(errno)));
    }
    writeAll(headerOf(scene, buildId));
}

JournalWriter::~JournalWriter() { close(descriptor_); }

void JournalWriter::writeAll(const files::Bytes& bytes) {
    const auto fail = [this] {
        const int why = errno;
        // What did get there is no record: the file then ends with the last whole one.
        [[maybe_unused]] const int cut = ftruncate(descriptor_, size_);
        throw files::InputError(
            fmt::format("{}: the journal cannot be written ({})", file_.string(), std::strerror(why)));
    };
    std::size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t count = write(descriptor_, bytes.data() + done, bytes.size() - done);
        if (count < 0 && errno != EINTR) {
            fail();
        }
        done += count > 0 ? static_cast<std::size_t>(count) : 0;
    }
    if (fdatasync(descriptor_) != 0 && errno != EINVAL && errno != EROFS) {  // pipes and the like cannot sync
        fail();
    }
    size_ += static_cast<std::int64_t>(bytes.size());
}

void JournalWriter::putRecord(std::uint8_t type, const files::Bytes& payload) {
    files::ByteWriter body;
    body.put(type);
    body.putBytes(payload);
    files::ByteWriter record;
    record.put(static_cast<std::uint32_t>(payload.size()));
    record.putBytes(body.bytes());
    record.put(checksum(body.bytes()));
    const files::Bytes& bytes = record.bytes();
    const std::size_t end = waiting_.size();
    waiting_.resize(end + bytes.size());
    std::copy(bytes.begin(), bytes.end(), waiting_.begin() + static_cast<std::ptrdiff_t>(end));
}

void JournalWriter::writeWaiting() {
    const files::Bytes bytes = std::exchange(waiting_, {});
    writeAll(bytes);
}

void JournalWriter::appendRecord(std::uint8_t type, const files::Bytes& payload) {
    putRecord(type, payload);
    writeWaiting();
}

void JournalWriter::keepTicks(const files::Bytes& piece) {
    putRecord(kTicksRecord, piece);
    if (waiting_.size() > kMostWaiting) {
        writeWaiting();
    }
}

void JournalWriter::append(const JournalFrame& frame) {
    files::ByteWriter payload;
    payload.putVarint(frame.frame);
    payload.put(frame.hashBefore);
    payload.putVarint(frame.steps.size());
    for (const sand::Step& step : frame.steps) {
        sand::encode(step, payload);
    }
    appendRecord(kFrameRecord, payload.bytes());
}

void JournalWriter::finish(std::uint64_t step, std::uint64_t hash) {
    files::ByteWriter payload;
    payload.put(step);
    payload.put(hash);
    appendRecord(kEndRecord, payload.bytes());
}

Journal readJournal(const std::filesystem::path& file) {
    std::error_code ignored;
    std::ifstream stream(file, std::ios::binary);
    if (!stream || std::filesystem::is_directory(file, ignored)) {
        throw files::InputError(fmt::format("{}: cannot be read; check the path", file.string()));
    }
    const files::Bytes bytes{std::istreambuf_iterator<char>(stream), {}};
    files::ByteReader reader(bytes);
    Journal journal;
    try {
        if (reader.get<std::uint32_t>() != kMagic) {
            throw files::FormatError("no journal of Sandwall");
        }
        if (const auto version = reader.get<std::uint32_t>(); version < kOldestVersion || version > kVersion) {
            throw files::FormatError(
                fmt::format("a journal of version {}; this program reads {} to {}", version, kOldestVersion, kVersion));
        }
        journal.buildId = reader.getText();
        const auto scene = reader.getBlock();
        const std::size_t checked = bytes.size() - reader.rest().size();
        if (reader.get<std::uint64_t>() != checksum(std::span(bytes).first(checked))) {
            throw files::FormatError("a journal whose header is damaged");
        }
        journal.scene = sand::Scene::decode(scene);
    } catch (const files::FormatError& error) {
        throw files::InputError(fmt::format("{}: {}", file.string(), error.what()));
    }
    while (!reader.atEnd()) {
        const auto rest = reader.rest();
        try {
            readRecord(reader, journal);
        } catch (const files::FormatError& error) {
            // A crash tears the last record. One that is followed by more was damaged on the disk, its length perhaps.
            if (holdsRecords(rest)) {
                throw files::InputError(fmt::format("{}: damaged at byte {} of {}: {}; what stands before it is whole",
                                                    file.string(), bytes.size() - rest.size(), bytes.size(),
                                                    error.what()));
            }
            journal.tornBytes = static_cast<std::int64_t>(rest.size());
            break;
        }
    }
    return journal;
}

}  // namespace master
