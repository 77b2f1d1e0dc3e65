// SPDX-License-Identifier: Apache-2.0
#include "master/journal/file_origin.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "host/version.hpp"
#include "sand/model/rules.hpp"

namespace master {
namespace {

constexpr std::size_t kLongestRelease = 32;  // [byte]

/// Returns whether `text` can be the name of a release. It is printed in messages and may come from a hostile file.
bool isReleaseName(std::string_view text) {
    return !text.empty() && text.size() <= kLongestRelease && std::all_of(text.begin(), text.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '-' ||
               c == '+';
    });
}

std::string refusalOf(const FileKind& kind, const FileOrigin& origin) {
    // A development build has the number of the next release, and may write other formats than that release.
    const std::string advice = origin.release == host::release()
                                   ? fmt::format("another build of {} wrote it, or it is damaged", origin.release)
                                   : fmt::format("use sandwall {}", origin.release);
    return fmt::format("written by sandwall {} ({} format {}, algorithm {}); this is {} (format {}, algorithm {}): {}",
                       origin.release, kind.name, origin.format, origin.algorithm, host::release(), kind.format,
                       sand::kAlgorithmVersion, advice);
}

}  // namespace

void writeOrigin(const FileKind& kind, base::ByteWriter& writer) {
    for (const std::uint32_t number : {kind.magic, kind.format, sand::kAlgorithmVersion}) {
        writer.put(number);
    }
    writer.putText(host::release());
}

FileOrigin readOrigin(const FileKind& kind, base::ByteReader& reader) {
    if (reader.get<std::uint32_t>() != kind.magic) {
        throw ForeignFile(fmt::format("not a Sandwall {} file", kind.name));
    }
    FileOrigin origin;
    origin.format = reader.get<std::uint32_t>();
    if (origin.format < kind.firstFormat) {
        throw ForeignFile("written before release 0.2.0; no release reads it; run the session again");
    }
    origin.algorithm = reader.get<std::uint32_t>();
    origin.release = reader.getText();
    if (!isReleaseName(origin.release)) {
        throw base::FormatError("its origin names no release");
    }
    if (origin.format != kind.format || origin.algorithm != sand::kAlgorithmVersion) {
        throw ForeignFile(refusalOf(kind, origin));
    }
    return origin;
}

}  // namespace master
