// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "walls/wall_check.hpp"
#include "walls/wall_file.hpp"

namespace walls::wall_file {
namespace {

bool isAmong(const std::vector<Tile>& tiles, const std::string& name) {
    return std::any_of(tiles.begin(), tiles.end(), [&](const Tile& tile) { return tile.name == name; });
}

std::string readName(const TomlTable& table, const std::vector<Tile>& others) {
    std::string name = table.text("name");
    if (!isTileName(name)) {
        table.fail("name", "name of a screen must be 1 to 32 letters, digits, '_' or '-'");
    }
    if (isAmong(others, name)) {
        table.fail("name", fmt::format("two tiles are called '{}'; give each its own name", name));
    }
    return name;
}

Screen readCorners(const TomlTable& table) {
    Screen screen;
    screen.lowerLeft = point(table, "lower_left");
    screen.lowerRight = point(table, "lower_right");
    screen.upperLeft = point(table, "upper_left");
    for (const auto& [key, side] :
         {std::pair{"lower_right", screen.width()}, std::pair{"upper_left", screen.height()}}) {
        if (!(side >= 1e-3)) {
            table.fail(key, fmt::format("{} must lie away from lower_left: the screen has no size", key));
        }
    }
    const glm::dvec3 up =
        squared(table, "upper_left", screen.right(), screen.upperLeft - screen.lowerLeft, "the edges at lower_left");
    screen.upperLeft = screen.lowerLeft + up;
    return screen;
}

/// Checks for screens that lie on one another. They are a measuring error unless the file declares them with
/// `overlaps`.
void checkContacts(const TomlTable& table, const Tile& tile, const std::vector<Tile>& others) {
    const std::vector<std::string> meant = table.textsOr("overlaps", {});
    for (const std::string& name : meant) {
        if (!isAmong(others, name)) {
            table.fail("overlaps", fmt::format("overlaps names '{}'; it must name a tile before this screen", name));
        }
    }
    for (const Tile& other : others) {
        const Contact contact = contactOf(tile.screen, other.screen);
        const bool declared = std::find(meant.begin(), meant.end(), other.name) != meant.end();
        if (contact == Contact::crossing) {
            table.fail("lower_left", fmt::format("screen '{}' passes through tile '{}': check the corners of both",
                                                 tile.name, other.name));
        }
        if (contact == Contact::overlapping && !declared) {
            table.fail("lower_left",
                       fmt::format("screen '{0}' lies on tile '{1}': check the corners, or write overlaps "
                                   "= [\"{1}\"] if both are to light one place",
                                   tile.name, other.name));
        }
        if (contact == Contact::none && declared) {
            table.fail("overlaps", fmt::format("screen '{}' does not lie on tile '{}': check the corners, or leave "
                                               "overlaps out",
                                               tile.name, other.name));
        }
    }
}

}  // namespace

Tile readScreen(const TomlTable& table, Stereo stereo, const std::vector<Tile>& others) {
    table.only({"name", "lower_left", "lower_right", "upper_left", "pixels", "overlaps"});
    if (others.size() >= static_cast<std::size_t>(kMaxTiles)) {
        table.fail("name", fmt::format("one screen too many: a wall has at most {} tiles", kMaxTiles));
    }
    Tile tile;
    tile.rank = static_cast<std::int32_t>(others.size()) + 1;
    tile.name = readName(table, others);
    tile.screen = readCorners(table);
    tile.pixels = pixels(table, "pixels");
    tile.outputs = outputsOf(stereo, tile.name);
    checkContacts(table, tile, others);
    return tile;
}

}  // namespace walls::wall_file
