// SPDX-License-Identifier: Apache-2.0
#include "walls/stereo_change.hpp"

#include <fmt/format.h>

#include "base/input_error.hpp"
#include "walls/wall_check.hpp"

namespace walls {
namespace {

void requireSameOutputs(const Tile& open, Stereo was, Tile& other, Stereo wanted) {
    if (open.outputs.size() > 1 && eyesOf(wanted).size() == 1) {
        other.outputs = open.outputs;
    }
    if (other.outputs.size() != open.outputs.size()) {
        throw base::InputError(fmt::format("{} needs {} output{} per tile, and tile '{}' has {}", stereoName(wanted),
                                           other.outputs.size(), other.outputs.size() == 1 ? "" : "s", open.name,
                                           open.outputs.size()));
    }
    const glm::ivec2 there = outputPixels(was, open.pixels);
    const glm::ivec2 needed = outputPixels(wanted, other.pixels);
    if (there != needed) {
        throw base::InputError(fmt::format("{} needs frames of {}x{} pixels, and those of tile '{}' have {}x{}",
                                           stereoName(wanted), needed.x, needed.y, open.name, there.x, there.y));
    }
}

Wall onItsOutputs(const Wall& wall, Stereo stereo) {
    Wall other = shownIn(wall, stereo);
    for (std::size_t i = 0; i < wall.tiles.size(); ++i) {
        requireSameOutputs(wall.tiles[i], wall.stereo, other.tiles[i], stereo);
    }
    if (const auto fault = viewFault(other)) {
        throw base::InputError(fmt::format("shown in {}: {}", stereoName(stereo), *fault));
    }
    return other;
}

}  // namespace

Wall shownOnItsOutputs(const Wall& wall, Stereo stereo) {
    if (stereo == wall.stereo) {
        return wall;
    }
    try {
        return onItsOutputs(wall, stereo);
    } catch (const base::InputError& error) {
        const std::vector<std::string> modes = otherModesOf(wall);
        const std::string known = modes.empty() ? "this wall can switch to no other mode"
                                                : fmt::format("this wall can switch to {}", fmt::join(modes, ", "));
        throw base::InputError(
            fmt::format("{}; {}; for others, end the session and start it with --stereo", error.what(), known));
    }
}

std::vector<std::string> otherModesOf(const Wall& wall) {
    std::vector<std::string> names;
    for (const auto& [stereo, name] : valuesOf(Stereo{})) {
        try {
            if (stereo != wall.stereo) {
                (void)onItsOutputs(wall, stereo);
                names.emplace_back(name);
            }
        } catch (const base::InputError&) {
            // These outputs cannot show this mode.
        }
    }
    return names;
}

}  // namespace walls
