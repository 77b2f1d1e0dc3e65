// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <utility>
#include <vector>

#include "haptic_bridge/client/client.hpp"

namespace master {

/// Edits that were asked for and that are in no step yet, oldest first. Used by one thread.
class WaitingEdits {
public:
    void add(sand::Edit edit) { edits_.push_back(std::move(edit)); }
    [[nodiscard]] bool any() const { return !edits_.empty(); }
    /// Returns the oldest waiting edit, or Edit::none.
    [[nodiscard]] sand::Edit next() const { return edits_.empty() ? sand::Edit() : edits_.front(); }
    /// Removes the edits whose numbers are in `steps`.
    void removeThoseIn(const std::vector<haptic_bridge::TimedStep>& steps) {
        for (const haptic_bridge::TimedStep& timed : steps) {
            if (timed.step.edit.any() && !edits_.empty() && timed.step.edit.number == edits_.front().number) {
                edits_.pop_front();
                askedEpoch_ = 0;
            }
        }
    }
    /// Returns the edit for which the server that numbers `epoch` is to be asked now, or null. It is asked for one edit
    /// at a time, because it keeps only one for its next step. If a link was lost with an edit, the next server is
    /// asked for it again.
    [[nodiscard]] const sand::Edit* nextToAsk(std::uint32_t epoch) {
        if (edits_.empty() || askedEpoch_ == epoch) {
            return nullptr;
        }
        askedEpoch_ = epoch;
        return &edits_.front();
    }

private:
    std::deque<sand::Edit> edits_;
    std::uint32_t askedEpoch_ = 0;  // epoch in which a server was asked for the first edit; 0: none was asked
};

}  // namespace master
