// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "base/byte_stream.hpp"
#include "sand/model/tool_shape.hpp"

namespace sand {

inline constexpr std::int32_t kLargestThreshold =
    1 << 30;  // [unit]; no sand slides then, because differences never exceed 2^29
inline constexpr std::int32_t kLargestToolRadius = 2048 << 8;  // [probe unit]; 2048 cells
inline constexpr std::int32_t kMostSweeps = 4096;              // most sweeps per step

/// The tool of the rules. A sphere that points east is encoded as its radius alone. Any other tool is encoded as −1 −
/// radius, kind, half width and heading.
struct ToolRules {
    ToolShape shape;
    Heading heading;  // the tool's heading until a hand turns it

    void encode(base::ByteWriter& writer) const;
    /// Reads what encode() wrote. Throws base::FormatError for a tool that no scene file can contain.
    static ToolRules decode(base::ByteReader& reader);
    [[nodiscard]] bool plain() const { return shape.kind == ToolKind::sphere && heading == Heading{}; }
    friend bool operator==(const ToolRules&, const ToolRules&) = default;
};

/// Rules that an operator may change during a session. scene/material.hpp computes them once; then they are sent as
/// whole numbers.
struct Tuning {
    std::int32_t threshold = 0, startThreshold = 0;  // [unit]
    std::int32_t sweepsPerStep = 0;
    std::int32_t toolRadius = 0;  // [probe unit]
    ToolKind toolKind = ToolKind::sphere;
    std::int32_t toolHalfWidth = 0;  // [probe unit], see ToolShape::halfWidth
    Heading toolHeading{};           // the tool's heading until a hand turns it

    [[nodiscard]] ToolRules tool() const { return {{toolKind, toolRadius, toolHalfWidth}, toolHeading}; }
    void encode(base::ByteWriter& writer) const;
    /// Reads what encode() wrote. Throws base::FormatError for numbers that no scene file can contain.
    static Tuning decode(base::ByteReader& reader);
    friend bool operator==(const Tuning&, const Tuning&) = default;
};

}  // namespace sand
