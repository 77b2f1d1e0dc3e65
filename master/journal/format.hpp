// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "base/byte_stream.hpp"
#include "master/journal/file_origin.hpp"
#include "sand/model/step.hpp"
#include "scene/material.hpp"
#include "scene/scene.hpp"

/// The bytes of a journal: header and records (docs/journal.md). Nothing here touches a file.
namespace master {

inline constexpr std::uint32_t kJournalVersion = 6;

/// The steps of one frame, as the journal holds them.
struct JournalFrame {
    std::uint64_t frame = 0;
    std::uint64_t hashBefore = 0;  // state hash before the first of the steps
    std::vector<sand::Step> steps;
};

/// The sand after a step: what the last record of a whole session holds, and the first bytes of a later part.
struct JournalEnd {
    std::uint64_t step = 0, hash = 0;
};

/// A session that had stopped goes on here.
struct JournalResumed {
    std::uint64_t frame = 0;  // the last that the journal knew of
    JournalEnd sand;
    std::int64_t cutBytes = 0;  // of a torn record, before this one
    std::string failure;        // what had failed; empty when nobody said
};

/// A piece of the haptic server's tick track.
struct JournalTicks {
    base::Bytes piece;
};

/// The rest of the session is in the next part.
struct JournalContinued {
    std::uint32_t part = 0;
};

using JournalRecord =
    std::variant<JournalFrame, JournalEnd, JournalTicks, JournalResumed, scene::Material, JournalContinued>;

/// What a journal's file begins with.
struct JournalHeader {
    FileOrigin origin;          // as read; encodeHeader() writes this program's instead
    std::uint64_t session = 0;  // a number that no other session has
    std::uint32_t part = 1;
    std::uint64_t continues = 0;  // checksum of the last record of the part before; 0 in the first
    JournalEnd sand;              // before its first step
    std::string buildId;
    base::Bytes scene;                        // scene::Scene::encode; empty in later parts
    std::optional<scene::Material> material;  // as the operator knows it; none in later parts
};

/// Thrown for a journal whose header is cut off or damaged.
class HeaderLost : public base::FormatError {
public:
    using base::FormatError::FormatError;
};

/// With its checksum, which begins the chain of the records behind it.
[[nodiscard]] base::Bytes encodeHeader(const JournalHeader& header, std::uint64_t& chain);
/// Throws HeaderLost or ForeignFile; the caller puts the file's name before the text. Does not decode the scene.
[[nodiscard]] JournalHeader decodeHeader(base::ByteReader& reader, std::uint64_t& chain);

/// One whole record; `chain` is the checksum of the one before, and then its own.
[[nodiscard]] base::Bytes encodeRecord(const JournalRecord& record, std::uint64_t& chain);
/// Of type and payload, whose checksum was right. Throws base::FormatError.
[[nodiscard]] JournalRecord decodeRecord(std::span<const std::uint8_t> body);
/// Of type and payload of a record.
[[nodiscard]] std::uint64_t recordChecksum(std::span<const std::uint8_t> body, std::uint64_t chain);

/// Returns whether an intact record follows anywhere in `rest`, which begins with a broken one. If so, the file was
/// damaged and not only cut off. `chain` is the checksum before `rest`.
[[nodiscard]] bool holdsRecords(std::span<const std::uint8_t> rest, std::uint64_t chain);

inline constexpr std::size_t kAroundPayload = sizeof(std::uint32_t) + 1 + sizeof(std::uint64_t);  // [byte]

}  // namespace master
