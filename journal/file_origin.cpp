// SPDX-License-Identifier: Apache-2.0
#include "journal/file_origin.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <cstring>
#include <new>

#include "sand/model/rules.hpp"

namespace journal {
namespace {

constexpr std::size_t kLongestRelease = 32;  // [byte]

/// Returns whether `text` can be the name of a release. It is printed in messages and may come from a hostile file.
bool isReleaseName(std::string_view text) {
    return !text.empty() && text.size() <= kLongestRelease && std::all_of(text.begin(), text.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '-' ||
               c == '+';
    });
}

std::string refusalOf(const FileKind& kind, std::string_view release, const FileOrigin& origin) {
    // A development build has the number of the next release, and may write other formats than that release.
    const std::string advice = origin.release == release
                                   ? fmt::format("another build of {} wrote it, or it is damaged", origin.release)
                                   : fmt::format("use sandwall {}", origin.release);
    return fmt::format("written by sandwall {} ({} format {}, algorithm {}); this is {} (format {}, algorithm {}): {}",
                       origin.release, kind.name, origin.format, origin.algorithm, release, kind.format,
                       sand::kAlgorithmVersion, advice);
}

}  // namespace

std::string FileOrigin::refusal() const { return isReleaseName(release) ? "" : "its origin names no release"; }

void writeOrigin(const FileKind& kind, std::string_view release, base::ByteWriter& writer) {
    base::putMember(writer, kind.magic);
    base::putMember(writer, FileOrigin{kind.format, sand::kAlgorithmVersion, std::string(release)});
}

FileOrigin readOrigin(const FileKind& kind, std::string_view release, base::ByteReader& reader) {
    if (base::read<std::uint32_t>(reader) != kind.magic) {
        throw ForeignFile(fmt::format("not a Sandwall {} file", kind.name));
    }
    base::ByteReader ahead = reader;
    if (base::read<std::uint32_t>(ahead) < kind.firstFormat) {
        throw ForeignFile("written before release 0.2.0; no release reads it; run the session again");
    }
    auto origin = base::read<FileOrigin>(reader);
    if (origin.format != kind.format || origin.algorithm != sand::kAlgorithmVersion) {
        throw ForeignFile(refusalOf(kind, release, origin));
    }
    return origin;
}

struct FileSum::State {
    std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> sum{XXH3_createState(), XXH3_freeState};
};

FileSum::FileSum() : state_(std::make_unique<State>()) {
    if (state_->sum == nullptr || XXH3_64bits_reset(state_->sum.get()) != XXH_OK) {
        throw std::bad_alloc();
    }
}

FileSum::~FileSum() = default;

void FileSum::add(std::span<const std::uint8_t> piece) {
    (void)XXH3_64bits_update(state_->sum.get(), piece.data(), piece.size());
}

std::uint64_t FileSum::value() const { return XXH3_64bits_digest(state_->sum.get()); }

std::uint64_t fileSum(std::span<const std::uint8_t> bytes) { return XXH3_64bits(bytes.data(), bytes.size()); }

std::span<const std::uint8_t> contentOf(std::span<const std::uint8_t> file, const base::ByteReader& reader) {
    std::uint64_t sum = 0;
    const auto rest = reader.rest();
    if (rest.size() < sizeof sum) {
        throw base::FormatError("cut short");
    }
    std::memcpy(&sum, file.data() + file.size() - sizeof sum, sizeof sum);
    if (sum != fileSum(file.first(file.size() - sizeof sum))) {
        throw base::FormatError("damaged: its checksum is wrong");
    }
    return rest.first(rest.size() - sizeof sum);
}

}  // namespace journal
