// SPDX-License-Identifier: Apache-2.0
#include "walls/desk_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "walls/projection.hpp"

namespace walls {
namespace {

constexpr double kFurther = 4;         // how much smaller than framed the sand may become
constexpr double kFrameMargin = 0.02;  // [share of the screens' side] around a box that was moved to be shown

std::array<glm::dvec3, 8> cornersOf(const TerrainBox& box) {
    std::array<glm::dvec3, 8> corners;
    for (unsigned i = 0; i < corners.size(); ++i) {
        corners[i] = {(i & 1U) != 0 ? box.high.x : box.low.x, (i & 2U) != 0 ? box.high.y : box.low.y,
                      (i & 4U) != 0 ? box.high.z : box.low.z};
    }
    return corners;
}

/// Range in which the middle of a box may lie so that all of the box is seen between two edges of the screens.
struct Range {
    double low = 0, high = 0;          // [m], for a box without size
    double fromLow = 0, fromHigh = 0;  // [m], needed beside the middle by the box at zoom 1

    [[nodiscard]] double largestZoom() const { return (high - low) / (fromLow + fromHigh); }
    [[nodiscard]] double middle(double zoom) const { return (low + zoom * fromLow + high - zoom * fromHigh) / 2; }
};

/// Returns the range along `axis` for a middle at the distance `depth` from the eye. `offsets` are the corners of the
/// box from its middle, and `low` and `high` the edges [per metre of distance].
Range rangeOf(const std::array<glm::dvec3, 8>& offsets, int axis, double low, double high, double depth) {
    const double margin = kFrameMargin * (high - low);
    low += margin;
    high -= margin;
    Range range{low * depth, high * depth, 0, 0};
    for (const glm::dvec3& offset : offsets) {
        range.fromLow = std::max(range.fromLow, low * offset.z - offset[axis]);
        range.fromHigh = std::max(range.fromHigh, offset[axis] - high * offset.z);
    }
    return range;
}

}  // namespace

DeskView::Opening::Opening(const Wall& wall) : eye(wall.viewer.eye), clip(wall.clip) {
    const Screen& first = wall.tiles.front().screen;
    toEye = glm::transpose(glm::dmat3(first.right(), first.up(), -first.normal()));
    constexpr double kFar = 1e9;
    left = bottom = kFar;
    right = top = -kFar;
    for (const Tile& tile : wall.tiles) {
        for (const glm::dvec3& corner :
             {tile.screen.lowerLeft, tile.screen.lowerRight, tile.screen.upperLeft, tile.screen.upperRight()}) {
            const glm::dvec3 place = seen(corner);
            left = std::min(left, place.x / place.z);
            right = std::max(right, place.x / place.z);
            bottom = std::min(bottom, place.y / place.z);
            top = std::max(top, place.y / place.z);
        }
    }
}

bool DeskView::Opening::shows(glm::dvec3 room) const {
    const glm::dvec3 place = seen(room);
    if (place.z < clip.near || place.z > clip.far) {
        return false;
    }
    constexpr double kRounding = 1e-9;
    const double x = place.x / place.z, y = place.y / place.z;
    return x >= left - kRounding && x <= right + kRounding && y >= bottom - kRounding && y <= top + kRounding;
}

DeskView::DeskView(const Wall& wall, const StagedField& field) : stage_(wall.stage), field_(field), opening_(wall) {
    const double room = stage_.width / std::max(field.width, field.height);  // [m per scene unit]
    const double diagonal = room * std::hypot(field.width, field.height);
    most_ = std::clamp((opening_.clip.far - opening_.seen(stage_.centre).z) / diagonal, 1.0, kMostZoom);
    least_ = 1 / kFurther;
}

glm::dmat4 DeskView::sceneToRoom(const Orbit& orbit) const {
    // A view that nobody has moved is exactly that of the wall file.
    return orbit == Orbit{} ? stageToRoom(stage_, field_.width, field_.height, field_.referenceZ)
                            : stageToRoom(stage_, field_.width, field_.height, field_.referenceZ, orbit);
}

void DeskView::aimAt(glm::dvec3 aim) {
    const double length = std::max(field_.width, field_.height);
    const glm::dvec3 most(length + field_.width / 2, length + field_.height / 2, 2 * length);
    orbit_.aim = glm::clamp(aim, glm::min(orbit_.aim, -most), glm::max(orbit_.aim, most));
}

void DeskView::pan(glm::dvec3 metres) { aimAt(orbit_.aim - glm::inverse(glm::dmat3(sceneToRoom())) * metres); }

bool DeskView::zoom(double notches, glm::dvec3 fixed) {
    const double before = orbit_.zoom;
    const glm::dvec3 fromAim = glm::inverse(glm::dmat3(sceneToRoom())) * (fixed - stage_.centre);
    orbit_.zoom =
        std::clamp(before * std::exp2(-notches / kNotchesToDouble), std::min(least_, before), std::max(most_, before));
    aimAt(orbit_.aim + fromAim * (1 - before / orbit_.zoom));
    return notches == 0 || orbit_.zoom != before;
}

void DeskView::frame(const TerrainBox& box) {
    orbit_ = {};
    const glm::dmat4 toRoom = sceneToRoom();
    const auto corners = cornersOf(box);
    if (!std::ranges::all_of(corners, [&](const glm::dvec3& corner) {
            return opening_.shows(glm::dvec3(toRoom * glm::dvec4(corner, 1)));
        })) {
        orbit_ = smallEnough(box);
    }
    least_ = orbit_.zoom / kFurther;
}

/// Returns the orbit with the largest sand, up to the size in the wall file, at which the screens show the whole box.
/// The middle of the box is as far away as stage.centre.
Orbit DeskView::smallEnough(const TerrainBox& box) const {
    const glm::dmat3 toRoom(sceneToRoom({}));
    const glm::dvec3 middle = (box.low + box.high) / 2.0;
    const double depth = opening_.seen(stage_.centre).z;
    std::array<glm::dvec3, 8> offsets = cornersOf(box);
    double nearest = 0, farthest = 0;
    for (glm::dvec3& offset : offsets) {
        offset = opening_.toEye * (toRoom * (offset - middle));
        nearest = std::max(nearest, -offset.z);
        farthest = std::max(farthest, offset.z);
    }
    if (depth <= opening_.clip.near || depth >= opening_.clip.far) {
        return {};  // the wall file puts the stage where nothing is drawn
    }
    const Range across = rangeOf(offsets, 0, opening_.left, opening_.right, depth);
    const Range up = rangeOf(offsets, 1, opening_.bottom, opening_.top, depth);
    Orbit orbit;
    orbit.zoom = std::min({1.0, across.largestZoom(), up.largestZoom(),
                           (1 - kFrameMargin) * (depth - opening_.clip.near) / nearest,
                           (1 - kFrameMargin) * (opening_.clip.far - depth) / farthest});
    const glm::dvec3 place(across.middle(orbit.zoom), up.middle(orbit.zoom), depth);
    const glm::dvec3 room = opening_.eye + glm::transpose(opening_.toEye) * place;
    const glm::dvec3 centre(field_.width / 2, field_.height / 2, field_.referenceZ);
    orbit.aim = middle - centre - glm::inverse(toRoom * orbit.zoom) * (room - stage_.centre);
    return orbit;
}

}  // namespace walls
