// SPDX-License-Identifier: Apache-2.0
#include "master/operator/pointer_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "sand/model/tool_shape.hpp"

namespace master {
namespace {

using lockstep::Overlay;

constexpr double kWider = 1.25;  // ratio of the tool's sizes before and after a key
constexpr double kMoreHumidity = 0.1;
constexpr std::array<std::pair<char, Overlay>, 5> kLayers{{{'g', Overlay::wireframe},
                                                           {'m', Overlay::hillShade},
                                                           {'f', Overlay::force},
                                                           {'s', Overlay::statistics},
                                                           {'h', Overlay::help}}};

}  // namespace

std::string commandOf(char key, const scene::Material& material, lockstep::Overlays layers) {
    if (key >= '1' && key < '1' + sand::kToolKinds) {
        return fmt::format("tool {}", base::nameOf(static_cast<sand::ToolKind>(key - '1')));
    }
    if (const auto* layer = std::ranges::find(kLayers, key, [](const auto& entry) { return entry.first; });
        layer != kLayers.end()) {
        const auto name = lockstep::kOverlayNames.at(static_cast<std::size_t>(layer->second));
        return fmt::format("{} {}", layers.shows(layer->second) ? "hide" : "show", name);
    }
    switch (key) {
        case '+':
        case '=':  // the same key without Shift, on many keyboards
            return fmt::format("tool radius={:.6g}", material.toolRadius * kWider);
        case '-':
            return fmt::format("tool radius={:.6g}", material.toolRadius / kWider);
        case 'w':
            return fmt::format("material humidity {:.6g}", std::min(1.0, material.humidity + kMoreHumidity));
        case 'd':
            return fmt::format("material humidity {:.6g}", std::max(0.0, material.humidity - kMoreHumidity));
        case 'u':
            return "undo";
        case 'R':
            return "reset";
        default:
            return {};
    }
}

}  // namespace master
