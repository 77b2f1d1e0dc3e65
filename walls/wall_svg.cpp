// SPDX-License-Identifier: Apache-2.0
#include "walls/wall_svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "walls/projection.hpp"
#include "walls/svg_page.hpp"

namespace walls {
namespace {

using Anchor = SvgPage::Anchor;

constexpr double kPanelWidth = 900, kPanelHeight = 640;  // [pixel], largest size of one view
constexpr double kTitleWidth = 540;                      // [pixel]
constexpr double kMargin = 90, kLetters = 13;            // [pixel]
constexpr SvgPage::Style kTileStyle{"#333333", "#cdd6e080", "", 1.2};
constexpr SvgPage::Style kSandStyle{"#a8701a", "#e8b45a55", "6 4", 1.5};
constexpr SvgPage::Style kSightStyle{"#888888", "none", "2 4", 1};
constexpr SvgPage::Style kEyeStyle{"#b01e1e", "#ffffff", "", 1.5};

std::vector<glm::dvec3> outlineOf(const Screen& s) { return {s.lowerLeft, s.lowerRight, s.upperRight(), s.upperLeft}; }

std::vector<glm::dvec3> sandCorners(const Wall& wall) {
    const glm::dmat4 toRoom = stageToRoom(wall.stage, 1, 1, 0);
    std::vector<glm::dvec3> corners;
    for (const glm::dvec2 c : {glm::dvec2(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
        corners.emplace_back(toRoom * glm::dvec4(c, 0, 1));
    }
    return corners;
}

/// Returns the tile that the front view shows straight on: a tile of the grid, or the screen that the viewer faces.
const Tile& mainTile(const Wall& wall) {
    const glm::dvec3 forward = glm::cross(glm::dvec3(0, 1, 0), wall.viewer.right);
    return *std::max_element(wall.tiles.begin(), wall.tiles.end(), [&](const Tile& a, const Tile& b) {
        return glm::dot(a.screen.normal(), forward) > glm::dot(b.screen.normal(), forward) + 1e-9;
    });
}

bool isFlat(const Wall& wall) {
    const Screen& first = wall.tiles.front().screen;
    return std::all_of(wall.tiles.begin(), wall.tiles.end(), [&](const Tile& tile) {
        return glm::distance(tile.screen.normal(), first.normal()) < 1e-6 &&
               std::abs(first.distanceTo(tile.screen.lowerLeft)) < 1e-6;
    });
}

/// Returns the lower left corner of the grid or screen that is drawn straight on.
glm::dvec3 mainCorner(const Wall& wall) {
    return mainTile(wall).row > 0 ? wall.grid->lowerLeft : mainTile(wall).screen.lowerLeft;
}

/// Returns whether the drawing should show the height of the lower edge above y = 0.
bool standsOnFloor(const Wall& wall) {
    const double height = mainCorner(wall).y;
    const double top = mainTile(wall).screen.upperLeft.y;
    return mainTile(wall).screen.up().y > 0.999 && height > 0.01 && height < top / 2;
}

/// Returns the place where the eye sees a point on the plane of the screen. Returns the point itself if it is not in
/// front of the eye.
glm::dvec3 seenOn(const Screen& screen, glm::dvec3 eye, glm::dvec3 point) {
    const double ahead = screen.distanceTo(eye) - screen.distanceTo(point);
    return ahead > 1e-3 ? eye + (point - eye) * (screen.distanceTo(eye) / ahead) : point;
}

/// View of the room, along two of its axes.
class Panel {
public:
    Panel(glm::dvec3 across, glm::dvec3 down) : across_(across), down_(down) {}

    void hold(glm::dvec3 point) {
        low_ = glm::min(low_, flat(point));
        high_ = glm::max(high_, flat(point));
    }
    [[nodiscard]] glm::dvec2 size() const { return high_ - low_; }  // [m]
    void put(double top, double scale) {
        top_ = top;
        scale_ = scale;
    }
    [[nodiscard]] glm::dvec2 at(glm::dvec3 point) const {
        return glm::dvec2(kMargin, top_) + (flat(point) - low_) * scale_;
    }
    [[nodiscard]] double bottom() const { return top_ + size().y * scale_; }
    [[nodiscard]] double right() const { return kMargin + size().x * scale_; }
    [[nodiscard]] double top() const { return top_; }
    void outline(SvgPage& page, const std::vector<glm::dvec3>& points, const SvgPage::Style& style) const {
        std::vector<glm::dvec2> flatPoints;
        std::transform(points.begin(), points.end(), std::back_inserter(flatPoints),
                       [&](glm::dvec3 point) { return at(point); });
        page.polygon(flatPoints, style);
    }

private:
    [[nodiscard]] glm::dvec2 flat(glm::dvec3 point) const { return {glm::dot(point, across_), glm::dot(point, down_)}; }

    glm::dvec3 across_, down_;
    glm::dvec2 low_{1e9}, high_{-1e9};  // [m]
    double top_ = 0, scale_ = 1;        // [pixel], [pixel/m]
};

/// Writes rank, name and pixels at the upper left of a tile, as large as fits.
void label(SvgPage& page, const Panel& panel, const Tile& tile) {
    glm::dvec2 low(1e9), high(-1e9);
    for (const glm::dvec3 corner : outlineOf(tile.screen)) {
        low = glm::min(low, panel.at(corner));
        high = glm::max(high, panel.at(corner));
    }
    const std::array<std::string, 2> lines{fmt::format("{} {}", tile.rank, tile.name),
                                           fmt::format("{}x{}", tile.pixels.x, tile.pixels.y)};
    const double size = std::min({kLetters, (high.x - low.x) / 7, (high.y - low.y) / 3});
    for (std::size_t i = 0; size >= 4 && i < lines.size(); ++i) {
        page.text({low.x + size / 2, low.y + size * 1.2 * static_cast<double>(i + 1)}, size, Anchor::start,
                  lines.at(i));
    }
}

/// Draws a tile: an area with its label. If the view shows the tile edge on, draws a thick line with rank and name
/// beside it.
void drawTile(SvgPage& page, const Panel& panel, const Tile& tile, glm::dvec3 towards) {
    const glm::dvec3 normal = tile.screen.normal();
    if (std::abs(glm::dot(normal, towards)) > 0.2) {
        panel.outline(page, outlineOf(tile.screen), kTileStyle);
        label(page, panel, tile);
        return;
    }
    panel.outline(page, outlineOf(tile.screen), {"#333333", "none", "", 3});
    const glm::dvec2 middle = (panel.at(tile.screen.lowerLeft) + panel.at(tile.screen.upperRight())) / 2.0;
    const glm::dvec2 away = panel.at(tile.screen.lowerLeft) - panel.at(tile.screen.lowerLeft + normal);
    const glm::dvec2 beside = glm::length(away) > 0 ? away / glm::length(away) : glm::dvec2(0);
    if (tile.row <= 1) {  // lower rows are hidden below the first
        page.text(middle + beside * glm::dvec2(36, 14) + glm::dvec2(0, 4), kLetters - 2, Anchor::middle,
                  fmt::format("{} {}", tile.rank, tile.name));
    }
}

/// Draws the sand's outline. Its name is at the middle of the near edge, where it covers nothing else.
void drawSand(SvgPage& page, const Panel& panel, const std::vector<glm::dvec3>& sand) {
    panel.outline(page, sand, kSandStyle);
    page.text(panel.at((sand[0] + sand[1]) / 2.0) - glm::dvec2(0, 6), kLetters - 2, Anchor::middle, "sand",
              kSandStyle.stroke);
}

std::string metres(double length) { return fmt::format("{:.3f} m", length); }

void gridDimensions(SvgPage& page, const Panel& front, const Wall& wall) {
    const Grid& grid = *wall.grid;
    const auto at = [&](int row, int column) -> const Screen& {
        return wall.tiles[static_cast<std::size_t>((row - 1) * grid.columns + column - 1)].screen;
    };
    const auto gapText = [](double gap) {
        return fmt::format("{} {:.1f} mm", gap < 0 ? "overlap" : "gap", std::abs(gap) * 1000);
    };
    const Screen& topLeft = at(1, 1);
    const Screen& bottomRight = at(grid.rows, grid.columns);
    const glm::dvec2 above(0, -14), far(0, -34), beside(14, 0), left(-30, 0);
    page.dimension(front.at(topLeft.upperLeft) + far, front.at(at(1, grid.columns).upperRight()) + far,
                   metres(glm::distance(topLeft.upperLeft, at(1, grid.columns).upperRight())), kLetters);
    page.dimension(front.at(topLeft.upperLeft) + left, front.at(at(grid.rows, 1).lowerLeft) + left, "", kLetters);
    page.text(front.at(topLeft.upperLeft) + left + glm::dvec2(0, -6), kLetters, Anchor::middle,
              metres(glm::distance(topLeft.upperLeft, at(grid.rows, 1).lowerLeft)), "#1560a8");
    if (grid.columns > 1) {
        page.dimension(front.at(topLeft.upperRight()) + above, front.at(at(1, 2).upperLeft) + above,
                       gapText(glm::dot(at(1, 2).upperLeft - topLeft.upperRight(), grid.right)), kLetters - 2);
    }
    if (grid.rows > 1) {
        const Screen& over = at(grid.rows - 1, grid.columns);
        page.dimension(front.at(over.lowerRight) + beside, front.at(bottomRight.upperRight()) + beside,
                       gapText(glm::dot(over.lowerRight - bottomRight.upperRight(), grid.up)), kLetters - 2);
    }
}

void viewerIn(SvgPage& page, const Panel& panel, const Wall& wall) {
    page.circle(panel.at(wall.viewer.eye), 9, kEyeStyle);
    for (const Eye eye : eyesOf(wall.stereo)) {
        page.circle(panel.at(eyePosition(wall.viewer, eye)), 2.5, {"#b01e1e", "#b01e1e", "", 1});
    }
    page.text(panel.at(wall.viewer.eye) + glm::dvec2(14, 4), kLetters, Anchor::start, "viewer", "#b01e1e");
}

void drawFront(SvgPage& page, const Panel& front, const Wall& wall, const std::vector<glm::dvec3>& sand) {
    const Screen& main = mainTile(wall).screen;
    for (const Tile& tile : wall.tiles) {
        drawTile(page, front, tile, main.normal());
    }
    drawSand(page, front, sand);
    if (standsOnFloor(wall)) {
        const glm::dvec3 corner = mainCorner(wall);
        const glm::dvec3 foot(corner.x, 0, corner.z);
        page.line(front.at(foot) - glm::dvec2(40, 0), {front.right(), front.at(foot).y}, {"#666666", "none", "", 1.5});
        page.dimension(front.at(corner) - glm::dvec2(30, 0), front.at(foot) - glm::dvec2(30, 0), "", kLetters);
        page.text((front.at(corner) + front.at(foot)) / 2.0 - glm::dvec2(24, -4), kLetters, Anchor::start,
                  metres(corner.y), "#1560a8");
    }
    if (wall.grid) {
        gridDimensions(page, front, wall);
    } else {
        page.dimension(front.at(main.upperLeft) + glm::dvec2(0, -14), front.at(main.upperRight()) + glm::dvec2(0, -14),
                       metres(main.width()), kLetters);
        page.dimension(front.at(main.upperRight()) - glm::dvec2(66, 0), front.at(main.lowerRight) - glm::dvec2(66, 0),
                       metres(main.height()), kLetters);
    }
    viewerIn(page, front, wall);
}

void drawPlan(SvgPage& page, const Panel& plan, const Wall& wall, const std::vector<glm::dvec3>& sand) {
    const Screen& main = mainTile(wall).screen;
    for (const Tile& tile : wall.tiles) {
        drawTile(page, plan, tile, main.up());
    }
    drawSand(page, plan, sand);
    for (const glm::dvec3 corner : {main.lowerLeft, main.lowerRight}) {
        const glm::dvec3 end =
            wall.grid && mainTile(wall).row > 0
                ? (corner == main.lowerLeft
                       ? wall.tiles.front().screen.lowerLeft
                       : wall.tiles[static_cast<std::size_t>(wall.grid->columns - 1)].screen.lowerRight)
                : corner;
        page.line(plan.at(wall.viewer.eye), plan.at(end), kSightStyle);
    }
    const glm::dvec3 eye = wall.viewer.eye;
    page.dimension(plan.at(eye - main.normal() * main.distanceTo(eye)), plan.at(eye), metres(main.distanceTo(eye)),
                   kLetters);
    viewerIn(page, plan, wall);
}

}  // namespace

std::string drawingOf(const Wall& wall) {
    const Screen& main = mainTile(wall).screen;
    const bool flatWall = isFlat(wall);
    const std::vector<glm::dvec3> sand = sandCorners(wall);
    std::vector<glm::dvec3> seen = sand;
    if (flatWall) {
        std::transform(sand.begin(), sand.end(), seen.begin(),
                       [&](glm::dvec3 corner) { return seenOn(main, wall.viewer.eye, corner); });
    }
    Panel front(main.right(), -main.up()), plan(main.right(), main.normal());
    for (Panel* panel : {&front, &plan}) {
        for (const Tile& tile : wall.tiles) {
            for (const glm::dvec3 corner : outlineOf(tile.screen)) {
                panel->hold(corner);
            }
        }
        for (const glm::dvec3 corner : panel == &front ? seen : sand) {
            panel->hold(corner);
        }
        panel->hold(wall.viewer.eye);
    }
    if (standsOnFloor(wall)) {
        const glm::dvec3 corner = mainCorner(wall);
        front.hold({corner.x, 0, corner.z});
    }
    const double width = std::max(front.size().x, plan.size().x);
    const double scale = std::min({kPanelWidth / width, kPanelHeight / std::max(front.size().y, 1e-3),
                                   kPanelHeight / std::max(plan.size().y, 1e-3)});
    SvgPage page;
    page.text({kMargin, 34}, 18, Anchor::start, wall.name);
    page.text({kMargin, 56}, kLetters, Anchor::start,
              fmt::format("{} render rank{}, {}; front view, {}", wall.ranks(), wall.ranks() == 1 ? "" : "s",
                          stereoName(wall.stereo),
                          flatWall ? "sand as the eye sees it on the wall" : "sand where it stands"));
    front.put(120, scale);
    drawFront(page, front, wall, seen);
    page.text({kMargin, front.bottom() + 62}, kLetters, Anchor::start,
              std::abs(main.up().y) > 0.7 ? "plan, from above" : "section, along the screen from its upper edge");
    plan.put(front.bottom() + 100, scale);
    drawPlan(page, plan, wall, sand);
    return page.finished({std::max({front.right(), plan.right(), kTitleWidth}) + kMargin + 20, plan.bottom() + 50});
}

}  // namespace walls
