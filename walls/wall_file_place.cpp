// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "walls/wall_check.hpp"
#include "walls/wall_file.hpp"
#include "walls/x_screen.hpp"

namespace walls::wall_file {
namespace {

constexpr int kMaxDevice = 63;
constexpr double kMaxDesktop = 32767;  // [pixel]; an X coordinate has 16 bits

struct Targets {
    std::vector<std::string> monitors;
    std::vector<glm::ivec2> windows;
};

/// Monitors and window areas that are already in use, by X screen (xScreenOf()) and by name or pixels.
struct Taken {
    struct Owner {
        std::string output;
        long line = 0;  // of the file, that gives the output its monitor or window
        Place place;
    };
    struct Window {
        std::string screen;
        Owner owner;
        glm::ivec2 low, high;
    };
    std::set<std::string> tiles;
    std::map<std::pair<std::string, std::string>, Owner> monitors;  // by X screen and name
    std::vector<Window> windows;
};

/// Returns whether a word can be part of a command line: no spaces, and no '-' at its start.
bool isWord(const std::string& word, const std::string& alsoAllowed) {
    return !word.empty() && word.size() <= 253 && word[0] != '-' && std::all_of(word.begin(), word.end(), [&](char c) {
        return isTileName(std::string_view(&c, 1)) || alsoAllowed.find(c) != std::string::npos;
    });
}

Place readPlace(const TomlTable& table) {
    Place place;
    if (table.has("host")) {
        place.host = table.text("host");
        if (!isWord(place.host, ".:")) {
            table.fail("host", fmt::format("host must be a name or address as mpirun takes it, got '{}'", place.host));
        }
    }
    if (table.has("display")) {
        place.display = table.text("display");
        const std::size_t colon = place.display.rfind(':');
        const bool numbered = colon != std::string::npos && colon + 1 < place.display.size() &&
                              place.display.find_first_not_of("0123456789.", colon + 1) == std::string::npos;
        if (!numbered || !isWord(place.display, ".:/")) {
            table.fail("display",
                       fmt::format("display must be an X display such as \":0\" or \":0.1\", got '{}'", place.display));
        }
    }
    place.device = table.integerOr("device", -1, 0, kMaxDevice);
    return place;
}

Targets readTargets(const TomlTable& table) {
    Targets targets;
    if (table.has("monitors") && table.has("windows")) {
        table.fail("windows", "outputs go to monitors or to windows, not to both: leave one list out");
    }
    targets.monitors = table.textsOr("monitors", {});
    for (const std::string& name : targets.monitors) {
        if (name.empty() || !isOneLine(name, 64)) {
            table.fail("monitors", "monitors must be names as xrandr lists them, such as \"DP-1\"");
        }
    }
    if (table.has("windows")) {
        for (const std::vector<double>& corner : table.numberLists("windows", 2)) {
            for (const double side : corner) {
                if (std::abs(side) > kMaxDesktop || side != std::floor(side)) {
                    table.fail("windows",
                               fmt::format("windows are at whole pixels within {} of the desktop's corner, got {}",
                                           kMaxDesktop, side));
                }
            }
            targets.windows.emplace_back(static_cast<int>(corner[0]), static_cast<int>(corner[1]));
        }
    }
    return targets;
}

std::vector<Tile*> readTiles(const TomlTable& table, std::vector<Tile>& tiles, Taken& taken) {
    std::vector<std::string> names;
    if (table.isText("tiles")) {
        if (const std::string word = table.text("tiles"); word != "all") {
            table.fail("tiles", fmt::format("tiles must be a list of names, or \"all\", got '{}'", word));
        }
        std::transform(tiles.begin(), tiles.end(), std::back_inserter(names), [](const Tile& t) { return t.name; });
    } else {
        names = table.textsOr("tiles", {});
    }
    if (names.empty()) {
        table.fail("tiles", "[place] needs tiles: a list of names such as [\"r1c1\"], or \"all\"");
    }
    std::vector<Tile*> found;
    for (const std::string& name : names) {
        const auto tile = std::find_if(tiles.begin(), tiles.end(), [&](const Tile& t) { return t.name == name; });
        if (tile == tiles.end()) {
            table.fail("tiles", fmt::format("no tile is called '{}'; the wall has {} tiles, from '{}' to '{}'", name,
                                            tiles.size(), tiles.front().name, tiles.back().name));
        }
        if (!taken.tiles.insert(name).second) {
            table.fail("tiles", fmt::format("tile '{}' has a place already: name it once", name));
        }
        found.push_back(&*tile);
    }
    return found;
}

void checkCount(const TomlTable& table, const char* key, std::size_t count, const Tile& tile) {
    if (table.has(key) && count != tile.outputs.size()) {
        table.fail(key, fmt::format("tile '{}' has {} output{}, but {} names {}: give one for each output", tile.name,
                                    tile.outputs.size(), tile.outputs.size() == 1 ? "" : "s", key, count));
    }
}

/// Returns that two places with different words are one display, or an empty text if their words are the same.
std::string oneDisplay(const Place& place, const Place& other) {
    const auto words = [](const Place& of) {
        return of.host.empty() || of.display.empty() ? of.host + of.display : of.host + " " + of.display;
    };
    return words(place) == words(other) ? ""
                                        : fmt::format(" ('{}' and '{}' are one display)", words(other), words(place));
}

/// Claims the output's monitor or window area. `host` is the host of the tile. If a table names no host, `host` is
/// different for each of its tiles, because each may be on another machine.
void claim(const TomlTable& table, const Tile& tile, const Output& output, glm::ivec2 size, const std::string& host,
           Taken& taken) {
    const std::string screen = xScreenOf(tile.place, host);
    if (!output.monitor.empty()) {
        const Taken::Owner owner{output.name, table.line("monitors"), tile.place};
        const auto [entry, fresh] = taken.monitors.try_emplace({screen, output.monitor}, owner);
        if (const Taken::Owner& other = entry->second; !fresh) {
            table.fail("monitors",
                       fmt::format("monitor '{}' would show output '{}' of tile '{}' and '{}' of line {} at once{}: "
                                   "name another monitor, or the host of each",
                                   output.monitor, output.name, tile.name, other.output, other.line,
                                   oneDisplay(tile.place, other.place)));
        }
    }
    if (output.window) {
        const glm::ivec2 low = *output.window, high = low + size;
        for (const auto& [itsScreen, other, itsLow, itsHigh] : taken.windows) {
            if (itsScreen == screen && glm::all(glm::lessThan(low, itsHigh)) && glm::all(glm::lessThan(itsLow, high))) {
                table.fail("windows", fmt::format("the window of output '{}' of tile '{}' ({}x{} pixels) would lie "
                                                  "over that of '{}' of line {}{}: move one",
                                                  output.name, tile.name, size.x, size.y, other.output, other.line,
                                                  oneDisplay(tile.place, other.place)));
            }
        }
        taken.windows.push_back({screen, {output.name, table.line("windows"), tile.place}, low, high});
    }
}

}  // namespace

void readPlaces(const TomlTable& file, Stereo stereo, std::vector<Tile>& tiles) {
    Taken taken;
    for (const TomlTable& table : file.tables("place")) {
        table.only({"tiles", "host", "display", "device", "monitors", "windows"});
        const Place place = readPlace(table);
        const Targets targets = readTargets(table);
        const std::vector<Tile*> placed = readTiles(table, tiles, taken);
        for (Tile* tile : placed) {
            checkCount(table, "monitors", targets.monitors.size(), *tile);
            checkCount(table, "windows", targets.windows.size(), *tile);
            tile->place = place;
            const bool anyHost = place.host.empty() && placed.size() > 1;
            for (std::size_t i = 0; i < tile->outputs.size(); ++i) {
                Output& output = tile->outputs[i];
                output.monitor = targets.monitors.empty() ? "" : targets.monitors[i];
                output.window = targets.windows.empty() ? std::nullopt : std::optional(targets.windows[i]);
                claim(table, *tile, output, outputPixels(stereo, tile->pixels),
                      anyHost ? "the host of " + tile->name : place.host, taken);
            }
        }
    }
}

}  // namespace walls::wall_file
