// SPDX-License-Identifier: Apache-2.0
#include "master/captures.hpp"

#include <fmt/format.h>

#include <exception>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/input_error.hpp"
#include "master/wall_pictures.hpp"

namespace master {
namespace {

/// Makes and returns the folder capture_001, or the first later one that does not exist. So the pictures of an earlier
/// session stay.
std::filesystem::path newFolder(const std::filesystem::path& out) {
    for (int number = 1;; ++number) {
        std::filesystem::path folder = out / fmt::format("capture_{:03}", number);
        std::error_code error;
        if (std::filesystem::create_directory(folder, error) || error) {
            return folder;  // if the folder could not be made, writing the first picture fails
        }
    }
}

}  // namespace

void Captures::take(std::uint64_t frame, const MasterSand& sand, const walls::Wall& wall,
                    const lockstep::Cluster& cluster, lockstep::Watchdog& watchdog, BackgroundJobs& jobs) {
    const std::filesystem::path folder = newFolder(out_);
    const BackgroundJobs::Result said{nlohmann::json({{"ok", true},
                                                      {"folder", folder.filename().string()},
                                                      {"frame", frame},
                                                      {"step", sand.replica().stepNumber()},
                                                      {"state_hash", fmt::format("{:016x}", sand.hash())}})
                                          .dump(),
                                      {}};
    std::function<void()> write;
    if (mayBeHeld(wall)) {
        auto held = std::make_shared<const HeldPictures>(holdWallPictures(cluster, wall, watchdog));
        write = [held = std::move(held), folder] { writeHeldPictures(*held, folder); };
    } else {
        std::exception_ptr refused;
        try {
            writeWallPictures(cluster, wall, folder, watchdog);
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
        [said, write = std::move(write)] {
            write();
            return said;
        },
        std::exchange(clients_, {}), BackgroundJobs::Kind::capture);
}

}  // namespace master
