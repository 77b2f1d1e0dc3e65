// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

#include "base/field_forms.hpp"
#include "base/names.hpp"
#include "sand/model/heading.hpp"
#include "sand/model/units.hpp"

namespace sand {

inline constexpr std::int32_t kLargestToolRadius = 2048 << 8;  // [probe unit]; 2048 cells
/// Largest tool of a height field without the changes for large tools: wider ring, longer sub-steps, coarse phase
/// [probe unit].
inline constexpr std::int32_t kLargestPlainTool = 16 * kProbePerCell;

/// Kind of a tool. The underside of a flat tool is level.
enum class ToolKind : std::uint8_t {
    sphere,
    circle,     // flat
    rectangle,  // flat
    ellipse,    // flat
    ellipsoid,
    footprint  // sole of a bare right foot
};
/// The names are those of scene files and operator commands.
constexpr auto valuesOf(ToolKind) {
    using enum ToolKind;
    return std::array{base::Named{sphere, "sphere"},       base::Named{circle, "circle"},
                      base::Named{rectangle, "rectangle"}, base::Named{ellipse, "ellipse"},
                      base::Named{ellipsoid, "ellipsoid"}, base::Named{footprint, "footprint"}};
}
inline constexpr int kToolKinds = static_cast<int>(valuesOf(ToolKind{}).size());

/// Returns whether the tool is a sphere or a circle. A round tool ignores width and heading.
[[nodiscard]] constexpr bool isRound(ToolKind kind) { return kind == ToolKind::sphere || kind == ToolKind::circle; }
/// Returns the default ratio of width to length.
[[nodiscard]] constexpr double usualWidth(ToolKind kind) {
    return isRound(kind) ? 1.0 : kind == ToolKind::footprint ? 0.4 : 0.5;
}

/// Kind, size and heading of a tool, without its position.
///
/// The lowest point of every tool is `radius` below its centre. A flat tool is a stamp whose underside is that far
/// below its centre.
struct Tool {
    ToolKind kind = ToolKind::sphere;
    std::int32_t radius = 0;     // half of the length [probe unit]
    std::int32_t halfWidth = 0;  // half of the width, at most the radius [probe unit]; 0 for a round tool
    Heading heading{};           // in rules: the heading until a hand turns the tool

    /// Returns the tool with another heading.
    [[nodiscard]] Tool turnedTo(const Heading& to) const { return {kind, radius, halfWidth, to}; }
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("kind", it.kind);
        visit("radius", base::limited(it.radius, 0, kLargestToolRadius));
        visit("half_width", base::limited(it.halfWidth, 0, it.radius));
        visit("heading", it.heading);
    }
    [[nodiscard]] std::string refusal() const {
        return isRound(kind) && halfWidth != 0 ? "is round, but has a width of its own" : "";
    }
    friend bool operator==(const Tool&, const Tool&) = default;
};

/// Returns the length of a sub-step of a tool of a height field along every axis [probe unit]. A large tool covers all
/// sand between its places if it moves by less than its width.
[[nodiscard]] constexpr std::int32_t substepOnGrid(const Tool& tool) {
    return std::max(tool.radius / 16, kProbePerCell);
}

/// Returns the heading of the tool in the hand, until now `held`, after an operator has replaced the tool of the rules.
/// A tool that a hand has turned keeps its heading, unless the operator turns the tool.
[[nodiscard]] inline Heading headingAfter(const Tool& before, const Tool& after, const Heading& held) {
    return after.heading != before.heading ? after.heading : held;
}

}  // namespace sand
