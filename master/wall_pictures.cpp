// SPDX-License-Identifier: Apache-2.0
#include "master/wall_pictures.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <optional>
#include <vector>

#include "files/input_error.hpp"
#include "lockstep/screenshots.hpp"
#include "pictures/image.hpp"
#include "pictures/png_file.hpp"
#include "pictures/stereo_packing.hpp"
#include "walls/canvas.hpp"

namespace master {
namespace {

/// Writes pictures and remembers the first failure: the ranks must be heard out before it is told.
class PictureFolder {
public:
    explicit PictureFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}

    void write(const std::string& name, const pictures::Image& image) {
        try {
            pictures::writePng(folder_ / name, image);
        } catch (const files::InputError& error) {
            failure_ = failure_ ? failure_ : error;
        }
    }
    void tellFailure() const {
        if (failure_) {
            throw *failure_;
        }
    }

private:
    std::filesystem::path folder_;
    std::optional<files::InputError> failure_;
};

}  // namespace

void writeWallPictures(const lockstep::Cluster& cluster, const walls::Wall& wall, const std::filesystem::path& folder,
                       lockstep::Watchdog& watchdog) {
    const std::span<const walls::Eye> eyes = walls::eyesOf(wall.stereo);
    const walls::Canvas canvas = walls::wallCanvas(wall);
    const bool fits = std::int64_t{canvas.width} * canvas.height <= pictures::kMaxPixels;
    if (!fits) {
        fmt::print(stderr,
                   "sandwall: {} x {} pixels are too many for one picture of the wall; its tiles are written alone\n",
                   canvas.width, canvas.height);
    }
    std::vector<pictures::Image> whole(eyes.size(),
                                       fits ? pictures::Image(canvas.width, canvas.height) : pictures::Image());
    const std::size_t perTile = eyes.size() + (walls::packsEyes(wall.stereo) ? 1 : 0);
    const std::vector<int> picturesByRank(static_cast<std::size_t>(cluster.size()), static_cast<int>(perTile));
    PictureFolder out(folder);
    std::size_t count = 0;
    watchdog.arm();
    lockstep::receivePictures(cluster, picturesByRank, [&](const lockstep::TilePicture& picture) {
        const walls::Tile& tile = wall.tiles[static_cast<std::size_t>(picture.rank - 1)];
        const auto eye = static_cast<std::size_t>(picture.eye);
        pictures::Image image;
        image.width = picture.width;
        image.height = picture.height;
        image.rgb = picture.pixels;
        if (eye < eyes.size()) {
            const walls::PixelRect& place = canvas.tiles[static_cast<std::size_t>(picture.rank - 1)];
            pictures::blit(whole[eye], image, place.x, place.y);
        }
        const std::string_view kind = eye < eyes.size() ? walls::eyeName(eyes[eye]) : "output";
        out.write(fmt::format("tile_{}_{}.png", tile.name, kind), image);
        fmt::print("pictures {}/{}\n", ++count, wall.tiles.size() * perTile);
        std::fflush(stdout);
        watchdog.arm();  // each picture has its own time
    });
    watchdog.disarm();
    if (!fits) {
        // said above
    } else if (eyes.size() == 1) {
        out.write("wall.png", whole[0]);
    } else {
        out.write("wall_left.png", whole[0]);
        out.write("wall_right.png", whole[1]);
        out.write("wall_anaglyph.png", pictures::packStereo(walls::Stereo::anaglyphColour, whole[0], whole[1]));
    }
    out.tellFailure();
}

}  // namespace master
