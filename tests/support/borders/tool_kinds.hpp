// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "sand/model/tool.hpp"

/// Kinds of tools that a test goes through. A new kind is among them by itself.
namespace support {

[[nodiscard]] constexpr std::array<sand::ToolKind, sand::kToolKinds> everyTool() {
    std::array<sand::ToolKind, sand::kToolKinds> kinds{};
    for (std::size_t i = 0; i < kinds.size(); ++i) {
        kinds[i] = valuesOf(sand::ToolKind{})[i].value;
    }
    return kinds;
}

/// Returns the kinds with a width and a heading.
[[nodiscard]] inline std::vector<sand::ToolKind> longTools() {
    std::vector<sand::ToolKind> kinds;
    for (const sand::ToolKind kind : everyTool()) {
        if (!sand::isRound(kind)) {
            kinds.push_back(kind);
        }
    }
    return kinds;
}

}  // namespace support
