// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/undo.hpp"

#include <utility>

namespace sand::tin {

void Undo::replaced(const VertexSand& layer) {
    copy_ = copy();
    parts_.replaced(layer);
}

void Undo::keep(const VertexSand& layer, const TinState& state) {
    parts_.bringUpToDate(layer);
    state_ = state;
    copy_ = nullptr;
    any_ = true;
}

void Undo::keep(std::shared_ptr<const Snapshot> copy) {
    copy_ = std::move(copy);
    any_ = true;
}

void Undo::forget() {
    copy_ = nullptr;
    any_ = false;
}

std::shared_ptr<const Snapshot> Undo::copy() const {
    if (any_ && copy_ == nullptr) {
        copy_ = std::make_shared<const Snapshot>(parts_.parts(), state_);
    }
    return copy_;
}

}  // namespace sand::tin
