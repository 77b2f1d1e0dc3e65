// SPDX-License-Identifier: Apache-2.0
#include "master/journal/saved_sand.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <new>
#include <optional>
#include <span>
#include <utility>

#include "base/input_error.hpp"
#include "host/regular_file.hpp"
#include "host/version.hpp"
#include "host/whole_file.hpp"
#include "journal/file_origin.hpp"
#include "sand/model/step.hpp"

namespace master {
namespace {

constexpr std::uint32_t kSavedMagic = 0x44535753;  // "SWSD"
constexpr journal::FileKind kSavedKind{.name = "saved sand", .magic = kSavedMagic, .format = 2, .firstFormat = 2};
constexpr std::size_t kMostAround = 2 * kLongestSceneName;  // [byte], everything except the sand

std::string shortName(const std::string& scene) { return scene.substr(0, kLongestSceneName); }

void requireSamePlace(const SandPlace& saved, const SandPlace& here) {
    if (saved.scene != shortName(here.scene)) {
        throw base::FormatError(fmt::format("sand of scene '{}', and this is '{}'", saved.scene, here.scene));
    }
    if (saved.columns != here.columns || saved.rows != here.rows) {
        throw base::FormatError(fmt::format("sand of {} x {} cells, and the scene has {} x {}", saved.columns,
                                            saved.rows, here.columns, here.rows));
    }
    if (saved.cellSize != here.cellSize || saved.aspect != here.aspect || saved.ground != here.ground) {
        throw base::FormatError(fmt::format("sand of '{}' with other cells or other rock", here.scene));
    }
}

/// A file that gets its name only when all of it is on disk.
class Unnamed {
public:
    explicit Unnamed(std::filesystem::path target) : target_(std::move(target)) {
        // Two threads may save under the same name. The file of the later one stays.
        static std::atomic<unsigned> number{0};
        beside_ = fmt::format("{}.{}.part", target_.string(), ++number);
        descriptor_ = host::makeFile(beside_);
        require(descriptor_ >= 0);
    }
    ~Unnamed() {
        if (descriptor_ >= 0) {
            close(descriptor_);
            unlink(beside_.c_str());
        }
    }
    Unnamed(const Unnamed&) = delete;
    Unnamed& operator=(const Unnamed&) = delete;

    void write(const base::Bytes& bytes) {
        require(host::writeAll(descriptor_, bytes));
        require(fsync(descriptor_) == 0);
    }
    /// Gives the file its name. The name survives a loss of power when the function returns.
    void name() {
        const std::string special = host::whyNotReplaceable(target_);
        if (!special.empty()) {
            throw base::InputError(fmt::format("{}: {}; nothing was saved", target_.string(), special));
        }
        require(rename(beside_.c_str(), target_.c_str()) == 0);
        close(std::exchange(descriptor_, -1));
        require(host::syncFolderOf(target_));
    }

private:
    void require(bool good) const {
        if (!good) {
            throw base::InputError(
                fmt::format("{}: cannot be written ({}); nothing was saved", target_.string(), std::strerror(errno)));
        }
    }
    std::filesystem::path target_, beside_;
    int descriptor_ = -1;
};

}  // namespace

SandPlace SandPlace::of(const scene::Scene& scene) {
    return {scene.name,
            scene.rules.columns,
            scene.rules.rows,
            scene.rules.aspect,
            scene.terrain.cellSize(),
            scene.rules.siteDigest(),
            scene.rules.stepLimits().mostSandBytes};
}

bool isSaveName(std::string_view name) {
    return !name.empty() && name.size() <= 64 && std::all_of(name.begin(), name.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    });
}

std::filesystem::path saveFile(const std::filesystem::path& session, std::string_view name) {
    return session / "saves" / fmt::format("{}.sand", name);
}

void writeSavedSand(const std::filesystem::path& file, const SavedSand& saved) {
    if (saved.sand.size() > static_cast<std::size_t>(saved.place.mostBytes)) {
        throw base::InputError(fmt::format("{}: {} bytes of sand could not be loaded again, {} is the most",
                                           file.string(), saved.sand.size(), saved.place.mostBytes));
    }
    try {
        host::makeFolders(file.parent_path());
    } catch (const std::filesystem::filesystem_error& error) {
        throw base::InputError(fmt::format("{}: cannot be made ({}); nothing was saved", file.parent_path().string(),
                                           error.code().message()));
    }
    Unnamed unnamed(file);
    unnamed.write(journal::encodeFile(kSavedKind, host::release(), saved));
    unnamed.name();
}

SavedSand readSavedSand(const std::filesystem::path& file, const SandPlace& place, const sand::SurfaceReader& read) {
    // Neither the file nor its folder in that of the session may be a link.
    const std::filesystem::path folder = file.parent_path();
    const host::RegularFile opened(folder.parent_path(), folder.filename() / file.filename());
    if (!opened.error().empty()) {
        throw base::InputError(fmt::format("{}: {}; nothing was loaded", file.string(), opened.error()));
    }
    try {
        const std::size_t most = static_cast<std::size_t>(place.mostBytes) + kMostAround;
        if (opened.size() > most) {
            throw base::FormatError(fmt::format("{} bytes are more than sand can be", opened.size()));
        }
        const std::optional<base::Bytes> bytes = opened.read(most);
        if (!bytes || bytes->empty()) {
            throw base::FormatError(bytes ? "is empty" : "cannot be read");
        }
        auto saved = journal::decodeFile<SavedSand>(kSavedKind, host::release(), *bytes);
        requireSamePlace(saved.place, place);
        // Decodes all of the sand before it is sent to the ranks, because a rank that applies a step cannot refuse it.
        (void)read(saved.sand);
        return saved;
    } catch (const base::FormatError& failure) {
        throw base::InputError(fmt::format("{}: {}; nothing was loaded", file.string(), failure.what()));
    } catch (const std::bad_alloc&) {
        throw base::InputError(fmt::format("{}: this machine has no memory for it; nothing was loaded", file.string()));
    }
}

}  // namespace master
