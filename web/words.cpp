// SPDX-License-Identifier: Apache-2.0
#include "web/words.hpp"

#include <fmt/format.h>

#include <vector>

#include "base/input_error.hpp"
#include "base/number.hpp"
#include "haptic_bridge/hand/tool_keys.hpp"
#include "web/replica/json_text.hpp"

namespace web {
namespace {

using sand::Edit;
using sand::ToolKind;

constexpr std::string_view kLeft = "left", kRight = "right";

bool needsOnlyItsName(Edit::Kind edit) { return edit != Edit::none && edit != Edit::tune && edit != Edit::load; }

/// The tool of a material, in the units of a scene file. It has only the parts that its kind has.
struct ToolNow {
    const scene::Material& of;
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        const ToolKind kind = it.of.toolKind;
        visit("kind", kind);
        visit("radius", it.of.toolRadius);
        if (!sand::isRound(kind)) {
            visit("width", it.of.toolWidth.value_or(sand::usualWidth(kind)));
            visit("heading", it.of.toolHeading);
        }
        if (kind == ToolKind::footprint) {
            visit("foot", it.of.leftFoot ? kLeft : kRight);
        }
    }
};

struct MaterialNow {
    const scene::Material& of;
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("material", scene::MaterialNumbers{it.of});
        visit("tool", ToolNow{it.of});
    }
};

struct NumberWord {
    const scene::MaterialKey& key;
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("word", it.key.word);
        visit("lowest", it.key.lowest);
        visit("highest", it.key.highest);
    }
};

struct DepthWords {
    template <class Self, class Visit>
    static void fields(Self& /*it*/, Visit& visit) {
        visit("lowest", haptic_bridge::kShallowest);
        visit("highest", haptic_bridge::kDeepest);
        visit("usual", haptic_bridge::kUsualDepth);
        visit("notch", haptic_bridge::kDepthPerNotch);
    }
};

struct Words {
    std::vector<std::string_view> tools{}, edits{};
    std::vector<NumberWord> material{};
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("tools", it.tools);
        visit("material", it.material);
        visit("edits", it.edits);
        visit("depth", DepthWords{});
    }
};

}  // namespace

std::string wordsOfPage() {
    const auto tools = base::namesOf<ToolKind>();
    Words words{.tools = {tools.begin(), tools.end()}};
    for (const scene::MaterialKey& key : scene::materialKeys()) {
        words.material.push_back({key});
    }
    for (const auto& known : valuesOf(Edit::Kind{})) {
        if (needsOnlyItsName(known.value)) {
            words.edits.push_back(known.name);
        }
    }
    words.edits.push_back(kRedo);
    return jsonOf(words);
}

std::string materialText(const scene::Material& material) { return jsonOf(MaterialNow{material}); }

scene::ToolChange toolChange(std::string_view part, std::string_view value) {
    scene::ToolChange change;
    if (part == "kind") {
        change.kind = base::valueNamed<ToolKind>(value);
    } else if (part == "foot" && (value == kLeft || value == kRight)) {
        change.leftFoot = value == kLeft;
    } else if (part == "radius" || part == "width" || part == "heading") {
        (part == "radius" ? change.radius : part == "width" ? change.width : change.heading) = base::numberOf(value);
    }
    if (!change.kind && !change.leftFoot && !change.radius && !change.width && !change.heading) {
        throw base::InputError(fmt::format("a tool's {} cannot be '{}'", part, value));
    }
    return change;
}

Edit editNamed(std::string_view name) {
    const auto kind = base::valueNamed<Edit::Kind>(name);
    if (!kind || !needsOnlyItsName(*kind)) {
        throw base::InputError(fmt::format("there is no edit '{}'", name));
    }
    return *kind;
}

}  // namespace web
