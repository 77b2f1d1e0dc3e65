// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace sand {

/// The sand of one moment, as far as it has changed since: each part as it was at that moment. A surface that follows
/// the record adds a part to it before, or soon after, this part first changes. Used in the thread of the surface.
class SurfaceRecord {
public:
    SurfaceRecord() = default;
    SurfaceRecord(const SurfaceRecord&) = delete;
    SurfaceRecord& operator=(const SurfaceRecord&) = delete;
    virtual ~SurfaceRecord() = default;
    /// Returns the memory that the record takes [byte].
    [[nodiscard]] virtual std::int64_t bytes() const = 0;
    /// Returns a record of the same moment without any part.
    [[nodiscard]] virtual std::shared_ptr<SurfaceRecord> withoutParts() const = 0;
};
using SurfaceRecords = std::vector<std::shared_ptr<SurfaceRecord>>;

class SurfaceCopy;

/// Makes and follows records of a surface. They leave the sand alone. Surface is derived from it.
/// All records that these functions take must come from this surface.
class SurfaceRecorder {
public:
    SurfaceRecorder() = default;
    SurfaceRecorder(const SurfaceRecorder&) = default;
    SurfaceRecorder& operator=(const SurfaceRecorder&) = default;
    SurfaceRecorder(SurfaceRecorder&&) = default;
    SurfaceRecorder& operator=(SurfaceRecorder&&) = default;
    virtual ~SurfaceRecorder() = default;
    /// Begins a record of this moment, and follows it beside the records that are followed already.
    [[nodiscard]] virtual std::shared_ptr<SurfaceRecord> record() = 0;
    /// Follows only these records from now on. A record that was not followed for a while must not have missed a change
    /// of a part that it lacks.
    virtual void follow(SurfaceRecords records) = 0;
    /// Follows only these records from the next time on that sand is restored: by a reset, an undo or a load.
    virtual void followAfterRestore(SurfaceRecords records) = 0;
    /// Returns the records that are followed. A copy of the surface follows none.
    [[nodiscard]] virtual const SurfaceRecords& followed() const = 0;
    /// Returns a record of the moment of `moment`, or of this moment if that is null, with the parts that `parts` has.
    /// `parts` must be followed, and so must `moment`, which is the later one.
    [[nodiscard]] virtual std::shared_ptr<SurfaceRecord> recordLike(const SurfaceRecord& parts,
                                                                    const SurfaceRecord* moment) = 0;
    /// Begins a snapshot, as Surface::beginCopy() does, of this sand with the parts of `records` in place of its own. A
    /// later record comes before an earlier one. There must be at least one.
    [[nodiscard]] virtual std::shared_ptr<const SurfaceCopy> beginCopyOf(const SurfaceRecords& records) = 0;
};

/// The records that a surface follows. A copy of a surface follows none.
class FollowedRecords {
public:
    FollowedRecords() = default;
    FollowedRecords(const FollowedRecords&) {}
    FollowedRecords& operator=(const FollowedRecords& other) {
        if (this != &other) {
            follow({});
        }
        return *this;
    }
    FollowedRecords(FollowedRecords&&) noexcept = default;
    FollowedRecords& operator=(FollowedRecords&&) noexcept = default;
    ~FollowedRecords() = default;

    [[nodiscard]] const SurfaceRecords& now() const { return now_; }
    void follow(SurfaceRecords records) {
        now_ = std::move(records);
        next_.clear();
        switches_ = false;
    }
    void followAfterRestore(SurfaceRecords records) {
        next_ = std::move(records);
        switches_ = true;
    }
    /// Call it when sand was restored. Returns whether other records are followed from now on.
    bool restored() {
        const bool switched = std::exchange(switches_, false);
        if (switched) {
            now_ = std::exchange(next_, {});
        }
        return switched;
    }

private:
    SurfaceRecords now_, next_;
    bool switches_ = false;
};

}  // namespace sand
