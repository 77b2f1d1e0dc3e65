// SPDX-License-Identifier: Apache-2.0
#include "sand/history.hpp"

#include <utility>

namespace sand {

SurfaceRecords History::followed() const {
    SurfaceRecords records;
    if (!undo_.empty()) {
        records.push_back(undo_.back().before);
    }
    if (returned_ != nullptr) {
        records.push_back(returned_);
    }
    return records;
}

void History::forgetAll(Replica& replica) {
    undo_.clear();
    redo_.clear();
    returned_.reset();
    replica.recorder().follow({});
    ++version_;
    keepsNewest_ = false;
    loneStroke_ = replica.canUndo();
}

void History::beginEntry(Replica& replica, bool strokeIsKept) {
    redo_.clear();
    returned_.reset();
    replica.recorder().follow({});
    undo_.push_back({replica.recorder().record(), label_});
    returnedLabel_ = label_;  // beginEdit() sets that of a change of the material
    if (undo_.size() > kMost) {
        undo_.erase(undo_.begin());
    }
    ++version_;
    keepsNewest_ = strokeIsKept;
    loneStroke_ = false;
}

void History::undo(Replica& replica) {
    Undo entry = std::move(undo_.back());
    undo_.pop_back();
    redo_.push_back({entry.before, replica.recorder().recordLike(*entry.before, returned_.get()), returnedLabel_});
    returned_ = entry.before->withoutParts();
    returnedLabel_ = entry.label;
    replica.recorder().followAfterRestore(followed());
    ++version_;
    moves_ = true;
}

void History::redo(Replica& replica) {
    Redo entry = std::move(redo_.back());
    redo_.pop_back();
    undo_.push_back({entry.before, returnedLabel_});
    returned_ = redo_.empty() ? nullptr : entry.after->withoutParts();
    returnedLabel_ = entry.label;
    replica.recorder().followAfterRestore(followed());
    ++version_;
    moves_ = true;
}

void History::begin(Replica& replica, const Step& step, const Intent& intent, Label label) {
    moves_ = false;
    if (replica.recorder().followed() != followed()) {  // the replica was healed, or is another one
        forgetAll(replica);
    }
    if (!replica.whyRefused(step).empty()) {
        return;
    }
    const bool starts = step.engaged && !replica.engaged();
    // After an undo, reset or load the tool only presses where it is. Its stroke is an entry when it moves.
    const bool continues =
        step.engaged && replica.engaged() && !inStroke_ && (!step.path.empty() || step.heading.has_value());
    if (starts || continues) {
        beginEntry(replica, starts);
        inStroke_ = true;
    }
    if (step.edit.any()) {
        beginEdit(replica, step, intent, label, starts || continues);
    }
}

void History::beginEdit(Replica& replica, const Step& step, const Intent& intent, Label label, bool hasEntry) {
    const bool wanted = intent.version == version_;
    const Move move = wanted ? intent.move : Move::none;
    const auto beginOwnEntry = [&] {
        if (!hasEntry) {
            beginEntry(replica, false);
        }
    };
    switch (step.edit.kind) {
        case Edit::none:
            return;
        case Edit::tune:
            if (label != label_ && move == Move::none) {
                beginOwnEntry();
                returnedLabel_ = label;
            } else if (label != label_ && returned_ == nullptr) {
                returned_ = replica.recorder().record();  // the sand before the sweeps of the material to return to
            }
            label_ = label;
            return;
        case Edit::settle:
            beginOwnEntry();
            return;
        case Edit::reset:
            beginOwnEntry();
            break;
        case Edit::load:
            if (move == Move::undo && !undo_.empty()) {
                undo(replica);
            } else if (move == Move::redo && !redo_.empty()) {
                redo(replica);
            } else {
                beginOwnEntry();
            }
            break;
        case Edit::undo:
            if (keepsNewest_) {
                undo(replica);
            } else if (loneStroke_) {
                ++version_;
            } else if (replica.canUndo()) {
                beginOwnEntry();  // goes back beyond the newest entry
            }
            break;
    }
    keepsNewest_ = loneStroke_ = inStroke_ = false;
}

void History::end(Replica& replica) {
    if (moves_ && !replica.leftOut().empty()) {
        forgetAll(replica);  // the sand was not restored
    }
    keepsNewest_ = keepsNewest_ && replica.canUndo();
    loneStroke_ = loneStroke_ && replica.canUndo();
    trim(replica);
}

std::int64_t History::bytes() const {
    std::int64_t bytes = returned_ != nullptr ? returned_->bytes() : 0;
    for (const Undo& entry : undo_) {
        bytes += entry.before->bytes();
    }
    for (const Redo& entry : redo_) {
        bytes += entry.before->bytes() + entry.after->bytes();
    }
    return bytes;
}

void History::trim(Replica& replica) {
    if (bytes() <= mostBytes_) {
        return;
    }
    while (bytes() > mostBytes_) {
        if (undo_.size() > 1 || (redo_.empty() && !undo_.empty())) {
            undo_.erase(undo_.begin());
        } else if (!redo_.empty()) {
            redo_.erase(redo_.begin());
        }
        if (redo_.empty()) {
            returned_.reset();
        }
    }
    if (undo_.empty()) {
        loneStroke_ = std::exchange(keepsNewest_, false) || loneStroke_;
        ++version_;
    }
    replica.recorder().follow(followed());
}

std::optional<History::Return> History::beginReturn(Replica& replica, Move move) const {
    SurfaceRecorder& recorder = replica.recorder();
    if (recorder.followed() != followed()) {
        return std::nullopt;  // the next step forgets all entries
    }
    const Intent intent{move, version_};
    if (move == Move::undo && (undo_.empty() ? loneStroke_ : keepsNewest_)) {
        return Return{Edit::undo, nullptr, returnedLabel_, intent};
    }
    if (move == Move::undo && !undo_.empty()) {
        const Undo& entry = undo_.back();
        return Return{Edit::load, recorder.beginCopyOf({entry.before}), entry.label, intent};
    }
    if (move == Move::redo && !redo_.empty()) {
        const Redo& entry = redo_.back();
        return Return{Edit::load, recorder.beginCopyOf({returned_, entry.after}), entry.label, intent};
    }
    return std::nullopt;
}

}  // namespace sand
