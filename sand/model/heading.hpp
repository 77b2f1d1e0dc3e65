// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/fields.hpp"

namespace sand {

/// Direction in which a tool points, seen from above. It is a vector of whole numbers, so that no replica computes with
/// angles. x runs east and y runs north.
struct Heading {
    static constexpr int kLength = 1 << 14;  // length of the vector before x and y are rounded

    std::int16_t x = kLength, y = 0;  // east, until the tool is turned
    bool mirrored = false;            // whether left and right are exchanged, as for a left foot

    /// Returns whether the length of the vector is kLength, except for rounding.
    [[nodiscard]] bool valid() const {
        const std::int64_t square = std::int64_t{x} * x + std::int64_t{y} * y;
        return square >= std::int64_t{kLength - 1} * (kLength - 1) &&
               square <= std::int64_t{kLength + 1} * (kLength + 1);
    }
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("x", it.x);
        visit("y", it.y);
        visit("mirrored", it.mirrored);
    }
    [[nodiscard]] std::string refusal() const { return valid() ? "" : "has the wrong length"; }
    friend bool operator==(const Heading&, const Heading&) = default;
};

/// Returns the heading for an angle, or nullopt if `degrees` is not finite. Degrees count from east, counter-clockwise
/// as seen from above. Only the process that reads a scene file, an operator's command or a device calls this function.
/// It sends the heading to the other processes, because the last digit of libm's results differs between hosts.
[[nodiscard]] std::optional<Heading> headingOf(double degrees, bool mirrored = false);
/// Returns the angle of `heading` for display, in (-180, 180] [degree].
[[nodiscard]] double degreesOf(const Heading& heading);

}  // namespace sand
