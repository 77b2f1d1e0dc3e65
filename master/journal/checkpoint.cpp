// SPDX-License-Identifier: Apache-2.0
#include "master/journal/checkpoint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <functional>
#include <optional>

#include "base/input_error.hpp"
#include "host/regular_file.hpp"
#include "host/version.hpp"
#include "host/whole_file.hpp"
#include "journal/file_origin.hpp"

namespace master {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kCheckpointMagic = 0x50435753;  // "SWCP"
constexpr journal::FileKind kCheckpointKind{
    .name = "checkpoint", .magic = kCheckpointMagic, .format = 2, .firstFormat = 2};
constexpr std::string_view kEnding = ".checkpoint";

fs::path folderOf(const fs::path& journal) { return journal.parent_path() / "checkpoints"; }

std::optional<std::uint64_t> stepOf(const std::string& name) {
    std::uint64_t step = 0;
    const char* const last = name.data() + name.size();
    const auto [end, error] = std::from_chars(name.data(), last, step);
    const bool named = error == std::errc() && std::string_view(end, static_cast<std::size_t>(last - end)) == kEnding;
    return named ? std::optional(step) : std::nullopt;
}

/// Writes bytes to a file.
class FileSink final : public base::ByteSink {
public:
    explicit FileSink(host::WholeFile& file) : file_(file) {}
    void write(std::span<const std::uint8_t> bytes) override {
        file_.stream().write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    }
    void overwrite(std::uint64_t place, std::span<const std::uint8_t> bytes) override {
        file_.stream().seekp(static_cast<std::streamoff>(place));
        write(bytes);
        file_.stream().seekp(0, std::ios::end);
    }

private:
    host::WholeFile& file_;
};

constexpr double kCompressed = 0.9;  // part of the work after which the file is read again for its checksum

/// Writes the bytes of Checkpoint::encode(), with the state that `putState` writes. Calls `done` for the part of the
/// work after that.
void putInto(host::WholeFile& file, const Checkpoint& checkpoint,
             const std::function<void(base::ByteWriter&)>& putState, const std::function<void(double)>& done) {
    FileSink sink(file);
    base::ByteWriter writer(sink);
    journal::writeOrigin(kCheckpointKind, host::release(), writer);
    base::Bytes head = base::encoded(Checkpoint{checkpoint.session,
                                                checkpoint.buildId,
                                                checkpoint.sceneDigest,
                                                checkpoint.step,
                                                checkpoint.frame,
                                                checkpoint.epoch,
                                                checkpoint.stateHash,
                                                {}});
    head.resize(head.size() - sizeof(std::uint32_t));  // without the length of the state, which is the last member
    writer.putBytes(head);
    const std::uint64_t place = writer.beginBlock();
    putState(writer);
    writer.endBlock(place);
    writer.flush();
    // Lengths come before what they are the lengths of, so the checksum can be computed only now.
    journal::FileSum sum;
    const auto size = static_cast<double>(file.stream().tellp());
    double read = 0;
    file.readBack([&](std::span<const std::uint8_t> piece) {
        sum.add(piece);
        read += static_cast<double>(piece.size());
        done(kCompressed + (1 - kCompressed) * std::min(1.0, read / size));
    });
    writer.put(sum.value());
    writer.flush();
}

void write(const fs::path& journal, const Checkpoint& checkpoint, std::size_t kept,
           const std::function<void(base::ByteWriter&)>& putState, const std::function<void(double)>& done) {
    try {
        host::makeFolders(folderOf(journal));
    } catch (const fs::filesystem_error& error) {
        throw base::InputError(
            fmt::format("{}: cannot be made ({})", folderOf(journal).string(), error.code().message()));
    }
    host::WholeFile file(checkpointFile(journal, checkpoint.step), host::WholeFile::Other::refused);
    putInto(file, checkpoint, putState, done);
    file.keepSynced();
    const std::vector<std::uint64_t> steps = checkpointsOf(journal);
    for (std::size_t i = kept; i < steps.size(); ++i) {
        std::error_code none;  // ignored, because an old checkpoint does no harm
        fs::remove(checkpointFile(journal, steps[i]), none);
    }
}

}  // namespace

base::Bytes Checkpoint::encode() const { return journal::encodeFile(kCheckpointKind, host::release(), *this); }

Checkpoint Checkpoint::decode(std::span<const std::uint8_t> bytes) {
    return journal::decodeFile<Checkpoint>(kCheckpointKind, host::release(), bytes);
}

fs::path checkpointFile(const fs::path& journal, std::uint64_t step) {
    return folderOf(journal) / fmt::format("{}{}", step, kEnding);
}

std::vector<std::uint64_t> checkpointsOf(const fs::path& journal) {
    std::vector<std::uint64_t> steps;
    std::error_code none;  // ignored, because the folder need not exist
    for (const auto& entry : fs::directory_iterator(folderOf(journal), none)) {
        if (const auto step = stepOf(entry.path().filename().string())) {
            steps.push_back(*step);
        }
    }
    std::sort(steps.begin(), steps.end(), std::greater<>());
    return steps;
}

void forgetHalves(const fs::path& journal) {
    std::vector<fs::path> halves;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(folderOf(journal), none)) {
        if (entry.path().extension() == ".part") {
            halves.push_back(entry.path());
        }
    }
    for (const fs::path& half : halves) {
        fs::remove(half, none);
    }
}

void writeCheckpoint(const fs::path& journal, const Checkpoint& checkpoint, std::size_t kept) {
    write(
        journal, checkpoint, kept, [&checkpoint](base::ByteWriter& writer) { writer.putBytes(checkpoint.state); },
        [](double) {});
}

void writeCheckpoint(const fs::path& journal, const Checkpoint& checkpoint, const sand::StateCopy& copy,
                     std::size_t kept, const std::function<void(double)>& done) {
    const auto compress = [&](base::ByteWriter& writer) {
        // Sand at rest has no fluxes, and need not have a stroke, so that the copy itself tells how many stripes it
        // has.
        const auto stripes = static_cast<double>(copy.stripes());
        double ended = 0;
        copy.encodeInto(writer, [&] { done(kCompressed * std::min(1.0, ++ended / stripes)); });
    };
    write(journal, checkpoint, kept, compress, done);
}

Checkpoint readCheckpoint(const fs::path& file) {
    // Neither the file nor its folder in that of the session may be a link.
    const fs::path folder = file.parent_path();
    const host::RegularFile opened(folder.parent_path(), folder.filename() / file.filename());
    const std::optional<base::Bytes> bytes = opened.error().empty() ? opened.read(opened.size()) : std::nullopt;
    if (!bytes || bytes->empty()) {
        throw base::FormatError(opened.error().empty() ? "cannot be read" : opened.error());
    }
    return Checkpoint::decode(*bytes);
}

}  // namespace master
