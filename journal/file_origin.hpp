// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "base/field_forms.hpp"

namespace journal {

inline constexpr std::size_t kLongestBuild = 256;  // [byte] of a build id

/// Release that wrote a file, with its format and algorithm. In journals, checkpoints and saved sand it follows the
/// magic number (docs/journal.md).
struct FileOrigin {
    std::uint32_t format = 0;
    std::uint32_t algorithm = 0;  // sand::kAlgorithmVersion
    std::string release;          // such as "0.2.0"
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("format", it.format);
        visit("algorithm", it.algorithm);
        visit("release", base::text(it.release, 1 << 16));
    }
    /// Returns that the release has no name that can be printed, or an empty text.
    [[nodiscard]] std::string refusal() const;
};

/// A kind of file that begins with its origin.
struct FileKind {
    std::string_view name;  // such as "journal"
    std::uint32_t magic = 0;
    std::uint32_t format = 0;       // the one format that this release writes and reads
    std::uint32_t firstFormat = 0;  // files of lower formats have no origin
};

/// Thrown for a file of another kind, and for one that only another release can read. The text says which.
class ForeignFile : public base::FormatError {
public:
    using base::FormatError::FormatError;
};

/// Writes the magic number and the origin of a program of the release `release`.
void writeOrigin(const FileKind& kind, std::string_view release, base::ByteWriter& writer);
/// Reads the magic number and the origin. `release` is that of this program, for the text of an error. Throws
/// ForeignFile if this program cannot read such a file, and another base::FormatError if the origin is cut short or
/// damaged. The caller puts the file's name before the text.
[[nodiscard]] FileOrigin readOrigin(const FileKind& kind, std::string_view release, base::ByteReader& reader);

/// Returns the checksum of the bytes of a checkpoint or of saved sand.
[[nodiscard]] std::uint64_t fileSum(std::span<const std::uint8_t> bytes);
/// The same checksum of bytes that come in pieces.
class FileSum {
public:
    FileSum();
    ~FileSum();
    FileSum(const FileSum&) = delete;
    FileSum& operator=(const FileSum&) = delete;
    void add(std::span<const std::uint8_t> piece);
    [[nodiscard]] std::uint64_t value() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};
/// Returns what is between the origin and the checksum of a `file`. `reader` has read the origin. Throws
/// base::FormatError if the checksum is wrong.
[[nodiscard]] std::span<const std::uint8_t> contentOf(std::span<const std::uint8_t> file,
                                                      const base::ByteReader& reader);

/// Returns a file with its origin, a described value and a checksum of both.
template <base::Described T>
[[nodiscard]] base::Bytes encodeFile(const FileKind& kind, std::string_view release, const T& value) {
    base::ByteWriter writer;
    writeOrigin(kind, release, writer);
    base::putMember(writer, value);
    base::putMember(writer, fileSum(writer.bytes()));
    return writer.take();
}

/// Returns the value in a file of encodeFile(). Throws as readOrigin() and contentOf() do, and if the value is invalid.
template <base::Described T>
[[nodiscard]] T decodeFile(const FileKind& kind, std::string_view release, std::span<const std::uint8_t> file) {
    base::ByteReader reader(file);
    (void)readOrigin(kind, release, reader);
    return base::decoded<T>(contentOf(file, reader));
}

}  // namespace journal
