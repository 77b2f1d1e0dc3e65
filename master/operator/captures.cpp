// SPDX-License-Identifier: Apache-2.0
#include "master/operator/captures.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <exception>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/input_error.hpp"
#include "master/pictures/wall_pictures.hpp"

namespace master {
namespace {

/// Returns the name of the only picture of the whole wall in a capture's folder, or that of the folder.
std::string pictureOf(const walls::Wall& wall, const std::filesystem::path& folder) {
    const bool one = walls::eyesOf(wall.stereo).size() == 1 && fitsOnePicture(wall);
    return one ? (folder / "wall.png").string() : folder.string() + "/";
}

}  // namespace

CaptureFolder::CaptureFolder(const std::filesystem::path& out) {
    errno = EEXIST;
    for (int number = 1; !made_ && errno == EEXIST; ++number) {
        path_ = out / fmt::format("capture_{:03}", number);
        made_ = mkdir(path_.c_str(), 0755) == 0;
    }
}

CaptureFolder::~CaptureFolder() {
    if (made_ && !whole_) {
        std::error_code none;
        std::filesystem::remove_all(path_, none);
    }
}

void Captures::take(std::uint64_t frame, const MasterSand& sand, const walls::Wall& wall,
                    lockstep::FrameBarrier& barrier, BackgroundJobs& jobs) {
    const auto folder = std::make_shared<CaptureFolder>(out_);
    BackgroundJobs::Result answer{nlohmann::json({{"ok", true},
                                                  {"folder", folder->path().filename().string()},
                                                  {"frame", frame},
                                                  {"step", sand.replica().stepNumber()},
                                                  {"state_hash", fmt::format("{:016x}", sand.hash())}})
                                      .dump(),
                                  {},
                                  fmt::format("picture saved as {}", pictureOf(wall, folder->path().filename()))};
    std::function<void()> write;
    if (mayBeHeld(wall)) {
        auto held = std::make_shared<const HeldPictures>(holdWallPictures(barrier, wall));
        write = [held = std::move(held), folder] { writeHeldPictures(*held, folder->path()); };
    } else {
        std::exception_ptr refused;
        try {
            writeWallPictures(barrier, wall, folder->path());
        } catch (const base::InputError&) {
            refused = std::current_exception();
        }
        write = [refused] {
            if (refused) {
                std::rethrow_exception(refused);
            }
        };
    }
    jobs.start(
        [answer = std::move(answer), write = std::move(write), folder] {
            write();
            folder->keep();
            return answer;
        },
        std::exchange(askers_, {}), BackgroundJobs::Kind::capture);
}

}  // namespace master
