// SPDX-License-Identifier: Apache-2.0
#include "walls/orbit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "base/input_error.hpp"
#include "walls/projection.hpp"

namespace walls {

Orbit Orbit::dragged(const Stage& stage, double right, double down) const {
    constexpr double kTurn = 180, kTilt = 90;  // [deg] for a drag over the whole window
    Orbit result = *this;
    result.turnDegrees = std::remainder(turnDegrees + kTurn * right, 360);
    const double now = stage.tiltDegrees + tiltDegrees;
    const double lowest = std::min(now, kLowest), highest = std::max(now, kHighest);
    result.tiltDegrees = std::clamp(now + kTilt * down, lowest, highest) - stage.tiltDegrees;
    return result;
}

std::string Orbit::text() const {
    return fmt::format("{},{},{},{},{},{}", zoom, turnDegrees, tiltDegrees, aim.x, aim.y, aim.z);
}

Orbit Orbit::parse(const std::string& text, const std::string& what) {
    std::array<double, 6> numbers{};
    const char* at = text.data();
    const char* const end = at + text.size();
    bool valid = true;
    for (std::size_t i = 0; valid && i < numbers.size(); ++i) {
        const auto [rest, error] = std::from_chars(at, end, numbers[i]);
        const bool last = i + 1 == numbers.size();
        valid = error == std::errc() && std::isfinite(numbers[i]) && (last ? rest == end : rest != end && *rest == ',');
        at = valid && !last ? rest + 1 : rest;
    }
    if (!valid || numbers[0] <= 0) {
        throw base::InputError(
            fmt::format("{}: '{}' must be ZOOM,TURN,TILT,EAST,NORTH,UP, such as 1,30,0,0,0,0, with a "
                        "zoom above 0",
                        what, text));
    }
    return {numbers[1], numbers[2], numbers[0], {numbers[3], numbers[4], numbers[5]}};
}

glm::dmat4 stageToRoom(const Stage& stage, double fieldWidth, double fieldHeight, double referenceZ,
                       const Orbit& orbit) {
    Stage tilted = stage;
    tilted.tiltDegrees += orbit.tiltDegrees;
    const glm::dvec3 centre(fieldWidth / 2, fieldHeight / 2, referenceZ);
    glm::dmat4 result = stageToRoom(tilted, fieldWidth, fieldHeight, referenceZ);
    result = glm::translate(result, centre);
    result = glm::rotate(result, glm::radians(orbit.turnDegrees), glm::dvec3(0, 0, 1));
    result = glm::scale(result, glm::dvec3(orbit.zoom));
    return glm::translate(result, -centre - orbit.aim);
}

bool isDesktop(const Wall& wall) {
    if (wall.stereo != Stereo::mono || !wall.tracking.empty()) {
        return false;
    }
    const Screen& first = wall.tiles.front().screen;
    constexpr double kFlat = 1e-3;  // [m]
    return std::ranges::all_of(wall.tiles, [&](const Tile& tile) {
        const Screen& screen = tile.screen;
        return std::ranges::all_of(std::array{screen.lowerLeft, screen.lowerRight, screen.upperLeft},
                                   [&](glm::dvec3 corner) { return std::abs(first.distanceTo(corner)) < kFlat; });
    });
}

}  // namespace walls
