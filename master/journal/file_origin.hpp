// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/byte_stream.hpp"

namespace master {

/// Release that wrote a file, with its format and algorithm. In journals, checkpoints and saved sand it follows the
/// magic number (docs/journal.md).
struct FileOrigin {
    std::uint32_t format = 0;
    std::uint32_t algorithm = 0;  // sand::kAlgorithmVersion
    std::string release;          // such as "0.2.0"
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

/// Writes the magic number and this program's origin.
void writeOrigin(const FileKind& kind, base::ByteWriter& writer);
/// Reads the magic number and the origin. Throws ForeignFile if this program cannot read such a file, and another
/// base::FormatError if the origin is cut short or damaged. The caller puts the file's name before the text.
[[nodiscard]] FileOrigin readOrigin(const FileKind& kind, base::ByteReader& reader);

}  // namespace master
