// SPDX-License-Identifier: Apache-2.0
#include "master/pictures/wall_pictures.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <optional>
#include <vector>

#include "base/input_error.hpp"
#include "host/print_line.hpp"
#include "lockstep/screenshots.hpp"
#include "pictures/png_file.hpp"
#include "pictures/stereo_packing.hpp"
#include "walls/canvas.hpp"

namespace master {
namespace {

/// Writes pictures and keeps the first error until all pictures of the ranks have been received.
class PictureFolder {
public:
    explicit PictureFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}

    void write(const std::string& name, const pictures::Image& image) {
        try {
            pictures::writePng(folder_ / name, image);
        } catch (const base::InputError& error) {
            failure_ = failure_ ? failure_ : error;
        }
    }
    void throwFailure() const {
        if (failure_) {
            throw *failure_;
        }
    }

private:
    std::filesystem::path folder_;
    std::optional<base::InputError> failure_;
};

/// Returns the number of pictures per tile: one per eye, and the output picture if both eyes are packed into one.
int picturesPerTile(const walls::Wall& wall) {
    return static_cast<int>(walls::eyesOf(wall.stereo).size()) + (walls::packsEyes(wall.stereo) ? 1 : 0);
}

std::string fileOf(const walls::Tile& tile, std::string_view kind) {
    return fmt::format("tile_{}_{}.png", tile.name, kind);
}

void writeWhole(const std::vector<pictures::Image>& whole, PictureFolder& out) {
    if (whole[0].rgb.empty()) {
        return;
    }
    if (whole.size() == 1) {
        out.write("wall.png", whole[0]);
        return;
    }
    out.write("wall_left.png", whole[0]);
    out.write("wall_right.png", whole[1]);
    out.write("wall_anaglyph.png", pictures::packStereo(walls::Stereo::anaglyphColour, whole[0], whole[1]));
}

constexpr std::int64_t kMostHeld = 1 << 28;  // [byte], of all tiles; the pictures of the whole wall take as much again

}  // namespace

bool mayBeHeld(const walls::Wall& wall) {
    std::int64_t bytes = 0;
    for (const walls::Tile& tile : wall.tiles) {
        bytes += std::int64_t{3} * tile.pixels.x * tile.pixels.y * picturesPerTile(wall);
    }
    return bytes <= kMostHeld;
}

bool fitsOnePicture(const walls::Wall& wall) {
    const walls::Canvas canvas = walls::wallCanvas(wall);
    return std::int64_t{canvas.width} * canvas.height <= pictures::kMaxPixels;
}

std::vector<pictures::Image> receiveWall(
    lockstep::FrameBarrier& barrier, const walls::Wall& wall,
    const std::function<void(const walls::Tile&, std::string_view, const pictures::Image&)>& each) {
    const std::span<const walls::Eye> eyes = walls::eyesOf(wall.stereo);
    const walls::Canvas canvas = walls::wallCanvas(wall);
    const bool fits = fitsOnePicture(wall);
    std::vector<pictures::Image> whole(eyes.size(),
                                       fits ? pictures::Image(canvas.width, canvas.height) : pictures::Image());
    const std::vector<int> picturesByRank(static_cast<std::size_t>(barrier.cluster().size()), picturesPerTile(wall));
    lockstep::receivePictures(barrier, picturesByRank, [&](const lockstep::TilePicture& picture) {
        const auto index = static_cast<std::size_t>(picture.rank - 1);
        const auto eye = static_cast<std::size_t>(picture.eye);
        pictures::Image image;
        image.width = picture.width;
        image.height = picture.height;
        image.rgb = picture.pixels;
        if (eye < eyes.size() && fits) {
            pictures::blit(whole[eye], image, canvas.tiles[index].x, canvas.tiles[index].y);
        }
        if (each) {
            each(wall.tiles[index], eye < eyes.size() ? walls::eyeName(eyes[eye]) : "output", image);
        }
    });
    return whole;
}

void writeWallPictures(lockstep::FrameBarrier& barrier, const walls::Wall& wall, const std::filesystem::path& folder) {
    const bool fits = fitsOnePicture(wall);
    if (!fits) {
        const walls::Canvas canvas = walls::wallCanvas(wall);
        host::printLine("{} x {} pixels are too many for one picture of the wall; its tiles are written alone",
                        canvas.width, canvas.height);
    }
    PictureFolder out(folder);
    std::size_t count = 0;
    const std::size_t all = wall.tiles.size() * static_cast<std::size_t>(picturesPerTile(wall));
    const std::vector<pictures::Image> whole =
        receiveWall(barrier, wall, [&](const walls::Tile& tile, std::string_view kind, const pictures::Image& image) {
            out.write(fileOf(tile, kind), image);
            fmt::print("pictures {}/{}\n", ++count, all);
            std::fflush(stdout);
        });
    writeWhole(whole, out);
    out.throwFailure();
}

HeldPictures holdWallPictures(lockstep::FrameBarrier& barrier, const walls::Wall& wall) {
    HeldPictures held;
    held.whole =
        receiveWall(barrier, wall, [&](const walls::Tile& tile, std::string_view kind, const pictures::Image& image) {
            held.tiles.push_back({fileOf(tile, kind), image});
        });
    return held;
}

void writeHeldPictures(const HeldPictures& held, const std::filesystem::path& folder) {
    PictureFolder out(folder);
    for (const HeldPictures::Tile& tile : held.tiles) {
        out.write(tile.file, tile.image);
    }
    writeWhole(held.whole, out);
    out.throwFailure();
}

}  // namespace master
