// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/field_forms.hpp"
#include "journal/file_origin.hpp"
#include "sand/model/step.hpp"
#include "scene/model/material.hpp"
#include "scene/model/scene.hpp"

/// Encodes and decodes the header and the records of a journal (docs/journal.md). Does not access files.
namespace journal {

inline constexpr std::uint32_t kJournalVersion = 10;

inline constexpr std::size_t kMostFailure = 1 << 20;  // [byte]

/// The steps of one frame, as the journal holds them. A frame without steps proves sand that rests: no step follows
/// until a hand moves or an edit comes.
struct JournalFrame {
    std::uint64_t frame = 0;
    std::uint64_t hashBefore = 0;  // state hash before the first of the steps; without steps, after the last step
    std::vector<sand::Step> steps;
    bool doubted = false;  // only when read: the hash does not count, because it follows a JournalDoubt
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("frame", base::varint(it.frame));
        visit("hash_before", it.hashBefore);
        visit("steps", base::upTo(it.steps, sand::kMostStepsOfAFrame));
    }
};

/// Hash of the sand after a step. The last record of a whole session and the header of a later part contain one.
struct JournalEnd {
    std::uint64_t step = 0, hash = 0;
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("step", it.step);
        visit("hash", it.hash);
    }
};

/// Marks the place where a session was resumed.
struct JournalResumed {
    std::uint64_t frame = 0;  // last frame in the journal before
    JournalEnd sand;
    std::int64_t cutBytes = 0;  // [byte], length of the torn record that was cut off before this one
    std::string failure;        // text that says what had failed, without a host; empty if unknown
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("frame", base::varint(it.frame));
        visit("sand", it.sand);
        visit("cut_bytes", it.cutBytes);
        visit("failure", base::text(it.failure, kMostFailure));
    }
};

/// A piece of the haptic server's tick track.
struct JournalTicks {
    base::Bytes piece;
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("piece", base::rest(it.piece));
    }
};

/// The ranks differed, and their majority decided which sand is right. The hashes of later frames do not count until a
/// JournalChecked or a JournalResumed.
struct JournalDoubt {
    std::uint64_t frame = 0;
    JournalEnd sand;  // of the majority
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("frame", base::varint(it.frame));
        visit("sand", it.sand);
    }
};

/// The majority's sand has been compared with the replay of this journal.
struct JournalChecked {
    std::uint64_t frame = 0;
    JournalEnd sand;        // that the ranks now have
    bool outvoted = false;  // the majority was wrong, and all ranks took the sand of the replay
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("frame", base::varint(it.frame));
        visit("sand", it.sand);
        visit("outvoted", it.outvoted);
    }
};

/// Last record of a part. The session continues in the next part.
struct JournalContinued {
    std::uint32_t part = 0;
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("part", it.part);
    }
};

/// Share of its force that the hand feels from here on, as an operator set it. Sand and hashes do not depend on it.
struct JournalForce {
    double share = 1;  // 0 to 1
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("share", base::limited(it.share, 0, 1));
    }
};

/// A record. Its type byte is the type's place in this list, counted from 1.
using JournalRecord = std::variant<JournalFrame, JournalEnd, JournalTicks, JournalResumed, scene::Material,
                                   JournalContinued, JournalDoubt, JournalChecked, JournalForce>;

/// Header of a journal's file.
struct JournalHeader {
    FileOrigin origin;          // only when read; encodeHeader() writes another
    std::uint64_t session = 0;  // random number of the session
    std::uint32_t part = 1;
    std::uint64_t continues = 0;  // checksum of the last record of the part before; 0 in the first part
    JournalEnd sand;              // sand before the file's first step
    std::string buildId;
    base::Bytes scene;                        // scene::Scene::encode(); empty in later parts
    std::optional<scene::Material> material;  // with the operator's numbers; nullopt in later parts
    /// The fields behind the origin.
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("part", it.part);
        visit("session", it.session);
        visit("continues", it.continues);
        visit("sand", it.sand);
        visit("build", base::text(it.buildId, kLongestBuild));
        visit("scene", base::block(it.scene));
        visit("material", base::optionalBlock(it.material));
    }
};

/// Error for a journal whose header is cut off or damaged.
class HeaderLost : public base::FormatError {
public:
    using base::FormatError::FormatError;
};

/// Returns the bytes of a header with its checksum, written by a program of the release `release`. Sets `chain` to the
/// checksum, with which the chain of the records begins.
[[nodiscard]] base::Bytes encodeHeader(const JournalHeader& header, std::string_view release, std::uint64_t& chain);
/// Reads a header and sets `chain` to its checksum. `release` is that of this program. Does not decode the scene.
/// Throws HeaderLost or ForeignFile. The caller puts the file's name before the text.
[[nodiscard]] JournalHeader decodeHeader(base::ByteReader& reader, std::string_view release, std::uint64_t& chain);

/// Returns the bytes of a whole record. `chain` is the checksum of the record before, and is set to the checksum of
/// this record. The first record of a write has a mark, `synced`: the length of the part before it, which is on disk
/// [byte].
[[nodiscard]] base::Bytes encodeRecord(const JournalRecord& record, std::uint64_t& chain,
                                       std::optional<std::uint64_t> synced = {});
/// Decodes a record from its type and payload, `body`. The caller has verified the checksum. Throws base::FormatError
/// if the payload is invalid.
[[nodiscard]] JournalRecord decodeRecord(std::span<const std::uint8_t> body);
/// Returns the mark of a record with type and payload `body`; nullopt if it is not the first of a write.
[[nodiscard]] std::optional<std::uint64_t> markOf(std::span<const std::uint8_t> body);
/// Returns the checksum of a record with type and payload `body`. `chain` is the checksum of the record before.
[[nodiscard]] std::uint64_t recordChecksum(std::span<const std::uint8_t> body, std::uint64_t chain);

/// Result of searchLaterWrite().
struct LaterWrite {
    bool found = false;
    std::uint64_t hashed = 0;  // [byte], all work of the search; a byte that is hashed twice counts twice
};
/// Searches for the begin of another write anywhere in `rest`, which begins with a broken record at `offset` [byte] of
/// its part. If one is found, the broken record had been on disk and was damaged later. Otherwise a crash has torn the
/// last write, of which any bytes may be missing.
///
/// Hashes at most kMostHashesOfTail times the length of `rest`, because any bytes may look like records within records.
/// A write that would need more hashing is not found, unless it is still at the place that its mark names.
[[nodiscard]] LaterWrite searchLaterWrite(std::span<const std::uint8_t> rest, std::uint64_t offset);
inline constexpr std::uint64_t kMostHashesOfTail = 3;  // with that of the broken record by the reader, four in all

inline constexpr std::size_t kAroundPayload = sizeof(std::uint32_t) + 1 + sizeof(std::uint64_t);  // [byte]

}  // namespace journal
