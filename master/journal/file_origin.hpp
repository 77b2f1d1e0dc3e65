// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/byte_stream.hpp"

namespace master {

/// Who wrote a file of a session, and how. Journals, checkpoints and saved sand begin with it, behind their magic
/// number (docs/journal.md).
struct FileOrigin {
    std::uint32_t format = 0;
    std::uint32_t algorithm = 0;  // sand::kAlgorithmVersion
    std::string release;          // such as "0.2.0"
};

/// A kind of file that begins with its origin.
struct FileKind {
    std::string_view name;  // such as "journal"
    std::uint32_t magic = 0;
    std::uint32_t format = 0;       // this release writes it, and reads no other
    std::uint32_t firstFormat = 0;  // of release 0.2.0; a file of a lower one holds no origin
};

/// A file of another kind, or one that only another release can read. The line says which.
class ForeignFile : public base::FormatError {
public:
    using base::FormatError::FormatError;
};

/// Magic number and origin of a file that this program writes.
void writeOrigin(const FileKind& kind, base::ByteWriter& writer);
/// Reads magic number and origin of a file that this program can read. Throws ForeignFile, or base::FormatError for an
/// origin that is cut short or damaged, in words that follow the file's name.
[[nodiscard]] FileOrigin readOrigin(const FileKind& kind, base::ByteReader& reader);

}  // namespace master
