// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <string>

#include "walls/wall.hpp"

namespace walls {

/// Area of a desktop that windows may cover.
struct DeskArea {
    glm::ivec2 size{1};    // [pixel]
    glm::ivec2 corner{0};  // [pixel], top left corner on the X screen

    /// Reads an X geometry, such as 1600x900+0+0. Throws base::InputError, which begins with `name`.
    static DeskArea parse(const std::string& text, const std::string& name);
    friend bool operator==(const DeskArea&, const DeskArea&) = default;
};

/// Returns the wall in windows of one desktop: one window and one eye per tile, all scaled by one factor of at most 1,
/// in the middle of `area`.
///
/// The windows of the grid have its rows, columns and bezels. The windows of explicit screens are below them, side by
/// side as in the map of sandwall-check. Hosts, displays, monitors and the tracker of the wall are left out. A window
/// shows one eye in each frame, so that a wall with eyes in turn has half its frames per second. Throws
/// base::InputError, in one line, if the wall does not fit even at one pixel per tile, or if no picture is possible
/// from the middle of the eyes.
[[nodiscard]] Wall placedOnDesk(const Wall& wall, const DeskArea& area, const std::string& file);

}  // namespace walls
