// SPDX-License-Identifier: Apache-2.0
#include "master/pictures/film.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>
#include <vector>

#include "base/input_error.hpp"
#include "host/regular_file.hpp"
#include "master/pictures/wall_pictures.hpp"
#include "pictures/png_file.hpp"
#include "pictures/stereo_packing.hpp"
#include "walls/canvas.hpp"

namespace master {
namespace {

constexpr std::size_t kDigits = 6;  // the launcher passes the same number to the program that makes the film

/// Returns whether `name` is the name of a film's picture, such as "frame_000001.png".
bool isFrame(const std::string& name) {
    const std::string_view before = "frame_";
    const std::string_view behind = ".png";
    if (!name.starts_with(before) || !name.ends_with(behind) || name.size() < before.size() + kDigits + behind.size()) {
        return false;
    }
    return std::all_of(name.begin() + static_cast<std::ptrdiff_t>(before.size()),
                       name.end() - static_cast<std::ptrdiff_t>(behind.size()),
                       [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

Film::Film(const walls::Wall& wall, std::optional<FilmEye> eye, std::filesystem::path folder)
    : wall_(wall), eye_(eye), folder_(std::move(folder)) {
    if (eye && walls::eyesOf(wall.stereo).size() < 2) {
        throw base::InputError(
            fmt::format("--eye: {} shown as {} draws one eye alone; choose another --stereo, such "
                        "as passive",
                        wall.name, walls::stereoName(wall.stereo)));
    }
    if (!fitsOnePicture(wall)) {
        const walls::Canvas canvas = walls::wallCanvas(wall);
        throw base::InputError(
            fmt::format("{}: {} x {} pixels are too many for one picture of the wall; film it on a "
                        "wall file with fewer",
                        wall.name, canvas.width, canvas.height));
    }
}

void Film::take(lockstep::FrameBarrier& barrier) {
    const std::vector<pictures::Image> eyes = receiveWall(barrier, wall_, nullptr);
    const std::filesystem::path file = folder_ / fmt::format("frame_{:0{}}.png", ++frames_, kDigits);
    if (eye_ == FilmEye::anaglyph) {
        pictures::writePng(file, pictures::packStereo(walls::Stereo::anaglyphColour, eyes[0], eyes[1]));
    } else if (!eye_ && walls::packsEyes(wall_.stereo)) {
        const auto& [first, second] = std::tie(eyes[wall_.swapEyes ? 1 : 0], eyes[wall_.swapEyes ? 0 : 1]);
        pictures::writePng(file, pictures::packStereo(wall_.stereo, first, second));
    } else {
        pictures::writePng(file, eyes[eye_ == FilmEye::right ? 1 : 0]);
    }
}

void Film::forget(const std::filesystem::path& folder) {
    std::error_code none;  // ignored, because usually no such file exists
    std::vector<std::filesystem::path> old{folder / "film.mp4"};
    for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
        if (isFrame(entry.path().filename().string())) {
            old.push_back(entry.path());
        }
    }
    for (const std::filesystem::path& file : old) {
        host::forgetFile(file);
    }
}

}  // namespace master
