// SPDX-License-Identifier: Apache-2.0
#include "master/journal/writer.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <random>
#include <utility>

#include "base/input_error.hpp"
#include "host/version.hpp"
#include "host/whole_file.hpp"
#include "master/journal/file_parts.hpp"
#include "scene/model/scene.hpp"

namespace master {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostWaiting = 1 << 20;  // [byte], of ticks while no step is made
constexpr std::size_t kMostHeld = 64 << 20;    // [byte], of ticks while the disk is full; a quarter of an hour of them

std::uint64_t newSession() {
    std::random_device random;
    return std::uint64_t{random()} << 32U | random();
}

PartFile makeFirst(const fs::path& file, const scene::Scene& scene, const std::string& buildId, std::uint64_t session,
                   std::uint64_t& chain) {
    keepPreviousJournal(file);
    journal::JournalHeader header;
    header.session = session;
    header.buildId = buildId;
    header.scene = scene.encode();
    header.material = scene.material;
    return PartFile::make(file, journal::encodeHeader(header, host::release(), chain));
}

}  // namespace

void keepPreviousJournal(const fs::path& journal) {
    std::error_code none;  // ignored, because there is usually no older journal
    if (!fs::is_regular_file(journal, none)) {
        return;
    }
    const fs::path kept = journal.string() + ".previous";
    for (std::uint32_t part = 2; fs::remove(partOf(kept, part), none); ++part) {
    }
    for (std::uint32_t part = 1; fs::is_regular_file(partOf(journal, part), none); ++part) {
        std::error_code error;
        fs::rename(partOf(journal, part), partOf(kept, part), error);
        if (error) {
            throw base::InputError(fmt::format("{}: cannot be kept as {} ({}); choose another --out",
                                               partOf(journal, part).string(), partOf(kept, part).filename().string(),
                                               error.message()));
        }
    }
    // Without this, a loss of power could bring the earlier journal back under the name of this session's.
    (void)host::syncFolderOf(journal);
}

JournalWriter::JournalWriter(const fs::path& file, const scene::Scene& scene, const std::string& buildId,
                             std::int64_t partBytes)
    : journal_(file),
      buildId_(buildId),
      partBytes_(partBytes),
      session_(newSession()),
      file_(makeFirst(file, scene, buildId, session_, chain_)) {}

JournalWriter::JournalWriter(const journal::JournalPlace& place, const std::string& buildId, std::int64_t partBytes)
    : journal_(place.journal),
      buildId_(buildId),
      partBytes_(partBytes),
      session_(place.session),
      part_(place.part),
      chain_(place.chain),
      file_(PartFile::open(partOf(place.journal, place.part), place.offset, place.seen)) {
    std::error_code none;  // the next part may exist without records, and may also be missing
    fs::remove(partOf(journal_, part_ + 1), none);
}

void JournalWriter::rotate(const journal::JournalEnd& now) {
    writeWaiting();
    // Makes the next part, with the checksum that it continues from, before this part names it.
    std::uint64_t chain = chain_;
    const base::Bytes continued =
        journal::encodeRecord(journal::JournalContinued{part_ + 1}, chain, static_cast<std::uint64_t>(file_.size()));
    journal::JournalHeader header;
    header.session = session_;
    header.part = part_ + 1;
    header.continues = chain;
    header.sand = now;
    header.buildId = buildId_;
    const base::Bytes begin = journal::encodeHeader(header, host::release(), chain);
    PartFile next = PartFile::make(partOf(journal_, part_ + 1), begin);
    file_.write(continued);
    file_ = std::move(next);
    chain_ = chain;
    ++part_;
}

JournalWriter::Room JournalWriter::makeRoom(std::int64_t bytes, const journal::JournalEnd& now, std::string& why) {
    if (file_.size() > partBytes_) {
        try {
            rotate(now);
        } catch (const base::InputError& error) {
            why = error.what();
            return Room::none;
        }
    }
    const int error = file_.reserve(bytes + static_cast<std::int64_t>(waiting_.size()));
    if (error == 0) {
        return Room::reserved;
    }
    why = file_.path().string() + ": " + std::strerror(error);
    return error == ENOSPC || error == EDQUOT ? Room::none : Room::unknown;
}

void JournalWriter::put(const journal::JournalRecord& record) {
    const std::size_t end = waiting_.size();
    const auto synced = end == 0 ? std::optional(static_cast<std::uint64_t>(file_.size())) : std::nullopt;
    const base::Bytes bytes = journal::encodeRecord(record, chain_, synced);
    waiting_.resize(end + bytes.size());
    std::memcpy(waiting_.data() + end, bytes.data(), bytes.size());
}

void JournalWriter::writeWaiting() {
    if (!waiting_.empty()) {
        file_.write(waiting_);
        waiting_.clear();
    }
}

bool JournalWriter::keep(const journal::JournalRecord& record) {
    if (waiting_.size() > kMostHeld && std::holds_alternative<journal::JournalTicks>(record)) {
        return false;
    }
    put(record);
    if (waiting_.size() > kMostWaiting) {
        writeIfRoom();
    }
    return true;
}

void JournalWriter::writeIfRoom() {
    const int error = file_.reserve(static_cast<std::int64_t>(waiting_.size()));
    if (error != ENOSPC && error != EDQUOT) {
        writeWaiting();
    }
}

void JournalWriter::append(const journal::JournalFrame& frame) {
    put(frame);
    writeWaiting();
}

void JournalWriter::resume(const journal::JournalResumed& resumed) {
    put(resumed);
    writeWaiting();
}

void JournalWriter::finish(std::uint64_t step, std::uint64_t hash) {
    put(journal::JournalEnd{step, hash});
    writeWaiting();
}

}  // namespace master
