// SPDX-License-Identifier: Apache-2.0
#include "scene/model/undo_history.hpp"

#include <algorithm>

namespace scene {

Material withToolOf(Material material, const Material& tool) {
    material.toolRadius = tool.toolRadius;
    material.toolKind = tool.toolKind;
    material.toolWidth = tool.toolWidth;
    material.toolHeading = tool.toolHeading;
    material.leftFoot = tool.leftFoot;
    return material;
}

void UndoHistory::begin(sand::Replica& replica, const sand::Step& step, const Intent& intent,
                        const std::optional<Material>& material) {
    if (material) {
        const auto found = std::find_if(materials_.begin(), materials_.end(), [&](const Material& one) {
            return withToolOf(one, *material) == *material;  // the tool does not count
        });
        label_ = static_cast<sand::History::Label>(found - materials_.begin());
        if (found == materials_.end()) {
            materials_.push_back(*material);
        }
    }
    history_.begin(replica, step, intent, label_);
}

std::optional<UndoHistory::Return> UndoHistory::beginReturn(sand::Replica& replica, Move move) const {
    const std::optional<sand::History::Return> how = history_.beginReturn(replica, move);
    return how ? std::optional(Return{*how, materials_.at(how->label)}) : std::nullopt;
}

}  // namespace scene
