// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "sand/model/surface_record.hpp"
#include "sand/tin/followed_parts.hpp"
#include "sand/tin/snapshot.hpp"

namespace sand::tin {

/// Record of a TIN: the vertices and constraints that have changed since its moment, as they were.
class Record final : public SurfaceRecord {
public:
    explicit Record(TinState then) : state(std::move(then)) {}
    static const Record& of(const SurfaceRecord& record) { return dynamic_cast<const Record&>(record); }

    [[nodiscard]] std::int64_t bytes() const override {
        return parts.bytes() +
               static_cast<std::int64_t>(state.imprint.points.capacity() * sizeof(Imprint::Point) +
                                         state.imprint.edges.capacity() * sizeof(state.imprint.edges.front()));
    }
    [[nodiscard]] std::shared_ptr<SurfaceRecord> withoutParts() const override {
        return std::make_shared<Record>(state);
    }

    EarlierParts parts;
    TinState state;
};

/// Snapshot of a TIN that is encoded only when its bytes are needed, by any thread.
class PartsCopy final : public SurfaceCopy {
public:
    PartsCopy(VertexSandParts parts, TinState state) : parts_(std::move(parts)), state_(std::move(state)) {}
    void encodeInto(base::ByteWriter& writer, const std::function<void()>& between) const override {
        Snapshot(parts_, state_).encodeInto(writer, between);
    }

private:
    VertexSandParts parts_;
    TinState state_;
};

/// Records of a TIN, which are brought up to date when they are read. A copy has none.
class Records {
public:
    Records() = default;
    Records(const Records&) {}
    Records& operator=(const Records&) = delete;

    [[nodiscard]] const SurfaceRecords& followed() const { return followed_.now(); }
    void reserve(std::size_t vertices) {
        if (parts_) {
            parts_->reserve(vertices);
        }
    }
    /// Call these for each change, as those of FollowedParts.
    void touch(const std::vector<Vertex>& vertices) {
        if (parts_) {
            parts_->touch(vertices);
        }
    }
    void touchTriangles(const std::vector<std::int32_t>& slots) {
        if (parts_) {
            parts_->touchTriangles(slots);
        }
    }
    /// Call it after the sand was replaced as a whole.
    void replaced(const VertexSand& layer);

    [[nodiscard]] std::shared_ptr<SurfaceRecord> record(const VertexSand& layer, const TinState& state);
    void follow(const VertexSand& layer, SurfaceRecords records);
    void followAfterRestore(const VertexSand& layer, SurfaceRecords records);
    [[nodiscard]] std::shared_ptr<SurfaceRecord> recordLike(const VertexSand& layer, const TinState& state,
                                                            const Record& parts, const Record* moment);
    [[nodiscard]] std::shared_ptr<const SurfaceCopy> copyOf(const VertexSand& layer, const SurfaceRecords& records);

private:
    void bringUpToDate(const VertexSand& layer);

    std::optional<FollowedParts> parts_;  // nullopt before the first record
    FollowedRecords followed_;
};

}  // namespace sand::tin
