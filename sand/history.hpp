// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "sand/model/surface_record.hpp"
#include "sand/replica.hpp"

namespace sand {

/// Strokes and edits of one replica that can be undone, and redone.
///
/// Each stroke, settle, reset, load and change of the material is an entry. The history has the sand before each entry,
/// as a SurfaceRecord. It leaves the state of the replica alone, so that other replicas need no history. The newest
/// stroke is undone by Edit::undo, if the replica still keeps its sand. Any other undo, and every redo, is a load of
/// the sand that beginReturn() returns. A new entry ends all redos. Not thread-safe.
class History {
public:
    static constexpr std::size_t kMost = 20;                             // entries
    static constexpr std::int64_t kMostBytes = std::int64_t{256} << 20;  // of all records

    /// Purpose of a step's load or tune.
    enum class Move : std::uint8_t { none, undo, redo };
    struct Intent {
        Move move = Move::none;
        std::uint64_t version = 0;  // version() when it was asked for
    };
    /// A number by which the caller finds the material of a moment.
    using Label = std::size_t;

    /// Begins without entries. The stroke that `replica` keeps can be undone, but not redone. `most` is in place of
    /// kMostBytes.
    explicit History(const Replica& replica, std::int64_t most = kMostBytes)
        : mostBytes_(most), loneStroke_(replica.canUndo()), inStroke_(replica.engaged()) {}

    /// Call these before and after each step of `replica`, always of the same one. `label` is that of the material
    /// after the step. A step of another intent than Move::none makes no entry, if no entry has begun since it was
    /// asked for.
    void begin(Replica& replica, const Step& step, const Intent& intent, Label label);
    void end(Replica& replica);

    [[nodiscard]] std::size_t undosLeft() const { return undo_.size() + (undo_.empty() && loneStroke_ ? 1 : 0); }
    [[nodiscard]] std::size_t redosLeft() const { return redo_.size(); }
    /// Returns a number that changes with each entry, undo and redo.
    [[nodiscard]] std::uint64_t version() const { return version_; }
    [[nodiscard]] std::int64_t bytes() const;  // of all records

    /// The edit that makes an undo or a redo.
    struct Return {
        Edit::Kind edit = Edit::undo;             // Edit::undo or Edit::load
        std::shared_ptr<const SurfaceCopy> sand;  // for a load; Replica::continueCopy() completes it
        Label label = 0;                          // of the material then
        Intent intent;                            // of the load, and of a change of the material before it
    };
    /// Returns how to undo the newest entry, or to redo the entry that was undone last. Returns nullopt if there is
    /// none.
    [[nodiscard]] std::optional<Return> beginReturn(Replica& replica, Move move) const;

private:
    struct Undo {
        std::shared_ptr<SurfaceRecord> before;  // of the moment before the entry
        Label label = 0;                        // before
    };
    struct Redo {
        std::shared_ptr<SurfaceRecord> before, after;  // of the entry; both have what differs between these moments
        Label label = 0;                               // after
    };

    void beginEntry(Replica& replica, bool strokeIsKept);
    void beginEdit(Replica& replica, const Step& step, const Intent& intent, Label label, bool hasEntry);
    void undo(Replica& replica);
    void redo(Replica& replica);
    void forgetAll(Replica& replica);
    [[nodiscard]] SurfaceRecords followed() const;
    void trim(Replica& replica);

    std::int64_t mostBytes_;
    std::vector<Undo> undo_;                   // the newest last; its record is followed
    std::vector<Redo> redo_;                   // the next last
    std::shared_ptr<SurfaceRecord> returned_;  // of the last undo or redo, or before the present one, and followed
    Label label_ = 0, returnedLabel_ = 0;      // of the present material, and of that after the newest entry
    std::uint64_t version_ = 0;
    bool keepsNewest_ = false;  // the replica keeps the sand before the newest entry, which is a stroke
    bool loneStroke_;           // the replica keeps the sand before a stroke that is older than the history
    bool inStroke_;             // the stroke of the engaged tool is an entry
    bool moves_ = false;        // the present step is an undo or redo of an entry
};

}  // namespace sand
