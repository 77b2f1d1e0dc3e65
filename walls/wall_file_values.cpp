// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "walls/wall_file.hpp"

namespace walls::wall_file {
namespace {

// A tape measure is accurate to 1 mm in 1 m. A corner that is off by more than twice that is a mistake.
constexpr double kSquareTolerance = 2e-3;  // largest cosine of the angle at a corner

std::string text(glm::dvec3 p) { return fmt::format("({:.3f}, {:.3f}, {:.3f})", p.x, p.y, p.z); }

}  // namespace

glm::dvec3 point(const TomlTable& table, std::string_view key) {
    const std::vector<double> n = table.numbers(key, 3);
    const glm::dvec3 result(n[0], n[1], n[2]);
    if (std::max({std::abs(n[0]), std::abs(n[1]), std::abs(n[2])}) > kMaxLength) {
        table.fail(key, fmt::format("{} is in metres and must lie within {} of the origin, got {}", key, kMaxLength,
                                    text(result)));
    }
    return result;
}

glm::dvec3 direction(const TomlTable& table, std::string_view key, glm::dvec3 fallback) {
    const std::vector<double> n = table.numbersOr(key, {fallback.x, fallback.y, fallback.z});
    const glm::dvec3 result(n[0], n[1], n[2]);
    const double size = glm::length(result);
    if (!(size > 1e-6 && size < 1e6)) {
        table.fail(key, fmt::format("{} must be a direction such as [1, 0, 0], got {}", key, text(result)));
    }
    return result / size;
}

double length(const TomlTable& table, std::string_view key, double value, double lowest) {
    if (!(value >= lowest && value <= kMaxLength)) {
        table.fail(key, value < lowest && lowest > 0
                            ? fmt::format("{} must be positive, got {}", key, value)
                            : fmt::format("{} is in metres and must be within [{}, {}], got {}", key, lowest,
                                          kMaxLength, value));
    }
    return value;
}

glm::dvec2 lengths(const TomlTable& table, std::string_view key, double lowest) {
    const std::vector<double> n = table.numbers(key, 2);
    return {length(table, key, n[0], lowest), length(table, key, n[1], lowest)};
}

glm::ivec2 pixels(const TomlTable& table, std::string_view key) {
    const std::vector<double> n = table.numbers(key, 2);
    for (const double side : n) {
        if (side < 1 || side > kMaxTileSide || side != std::floor(side)) {
            table.fail(key,
                       fmt::format("{} must be two whole numbers within [1, {}], got {}", key, kMaxTileSide, side));
        }
    }
    return {static_cast<int>(n[0]), static_cast<int>(n[1])};
}

glm::dvec3 squared(const TomlTable& table, std::string_view key, glm::dvec3 right, glm::dvec3 up,
                   const std::string& what) {
    const double size = glm::length(up);
    const double cosine = glm::dot(right, up) / size;
    if (!(std::abs(cosine) <= kSquareTolerance)) {
        table.fail(key, fmt::format("{} must be at right angles, got {:.2f} degrees", what,
                                    glm::degrees(std::acos(std::clamp(cosine, -1.0, 1.0)))));
    }
    return glm::normalize(up - right * glm::dot(right, up)) * size;
}

}  // namespace walls::wall_file
