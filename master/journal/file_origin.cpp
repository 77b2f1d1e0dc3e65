// SPDX-License-Identifier: Apache-2.0
#include "master/journal/file_origin.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "host/version.hpp"
#include "sand/model/rules.hpp"

namespace master {
namespace {

constexpr std::size_t kLongestRelease = 32;  // [byte]

/// Whether a release may be called that: the text stands in a message, and may come from anybody's file.
bool isReleaseName(std::string_view text) {
    return !text.empty() && text.size() <= kLongestRelease && std::all_of(text.begin(), text.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '-' ||
               c == '+';
    });
}

std::string refusalOf(const FileKind& kind, const FileOrigin& origin) {
    // A build before a release bears that release's number, and need not write the formats of the release.
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
        throw ForeignFile(fmt::format("no {} of Sandwall", kind.name));
    }
    FileOrigin origin;
    origin.format = reader.get<std::uint32_t>();
    if (origin.format < kind.firstFormat) {
        throw ForeignFile("written before release 0.2.0, which no release reads; run the session again");
    }
    origin.algorithm = reader.get<std::uint32_t>();
    origin.release = reader.getText();
    if (!isReleaseName(origin.release)) {
        throw base::FormatError("it names no release that wrote it");
    }
    if (origin.format != kind.format || origin.algorithm != sand::kAlgorithmVersion) {
        throw ForeignFile(refusalOf(kind, origin));
    }
    return origin;
}

}  // namespace master
