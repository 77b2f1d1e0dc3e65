// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "sand/history.hpp"
#include "scene/model/material.hpp"

namespace scene {

/// Returns `material` with the tool of `tool`.
[[nodiscard]] Material withToolOf(Material material, const Material& tool);

/// The sand::History of a session, with the material of each moment. Used by one thread.
class UndoHistory {
public:
    using Move = sand::History::Move;
    using Intent = sand::History::Intent;

    /// `material` is the present one. `mostBytes` is for sand::History.
    UndoHistory(const sand::Replica& replica, const Material& material,
                std::int64_t mostBytes = sand::History::kMostBytes)
        : history_(replica, mostBytes), materials_{material} {}

    /// Call these before and after each step of `replica`. The edit of the step sets `material`, unless that is
    /// nullopt.
    void begin(sand::Replica& replica, const sand::Step& step, const Intent& intent,
               const std::optional<Material>& material);
    void end(sand::Replica& replica) { history_.end(replica); }

    [[nodiscard]] const sand::History& entries() const { return history_; }

    /// The edit that makes an undo or a redo, and the material to which it returns.
    struct Return {
        sand::History::Return how;
        Material material;  // with any tool
    };
    /// Returns nullopt if there is nothing to undo or redo.
    [[nodiscard]] std::optional<Return> beginReturn(sand::Replica& replica, Move move) const;

private:
    sand::History history_;
    std::vector<Material> materials_;  // by sand::History::Label
    sand::History::Label label_ = 0;   // of the present material
};

}  // namespace scene
