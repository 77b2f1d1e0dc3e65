// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/record.hpp"

namespace sand::tin {

void Records::bringUpToDate(const VertexSand& layer) {
    if (!parts_) {
        parts_.emplace(layer);
        return;
    }
    const EarlierParts changed = parts_->takeChanges(layer);
    for (const std::shared_ptr<SurfaceRecord>& record : followed_.now()) {
        dynamic_cast<Record&>(*record).parts.addMissing(changed);
    }
}

void Records::replaced(const VertexSand& layer) {
    if (!parts_) {
        return;
    }
    if (followed_.restored()) {
        parts_->replaced(layer);
    } else {
        parts_->touchAll(layer);
        bringUpToDate(layer);
    }
}

std::shared_ptr<SurfaceRecord> Records::record(const VertexSand& layer, const TinState& state) {
    bringUpToDate(layer);
    auto record = std::make_shared<Record>(state);
    SurfaceRecords all = followed_.now();
    all.push_back(record);
    followed_.follow(std::move(all));
    return record;
}

void Records::follow(const VertexSand& layer, SurfaceRecords records) {
    if (parts_) {  // without a record so far, as in a rank, nothing has a copy of the sand
        bringUpToDate(layer);
    }
    followed_.follow(std::move(records));
}

void Records::followAfterRestore(const VertexSand& layer, SurfaceRecords records) {
    bringUpToDate(layer);
    followed_.followAfterRestore(std::move(records));
}

std::shared_ptr<SurfaceRecord> Records::recordLike(const VertexSand& layer, const TinState& state, const Record& parts,
                                                   const Record* moment) {
    bringUpToDate(layer);
    auto like = std::make_shared<Record>(moment == nullptr ? state : moment->state);
    like->parts = parts_->presentOf(parts.parts);
    if (moment != nullptr) {
        EarlierParts then = moment->parts;
        then.addMissing(like->parts);
        like->parts = std::move(then);
    }
    return like;
}

std::shared_ptr<const SurfaceCopy> Records::copyOf(const VertexSand& layer, const SurfaceRecords& records) {
    bringUpToDate(layer);
    VertexSandParts parts = parts_->parts();
    for (const std::shared_ptr<SurfaceRecord>& record : records) {
        Record::of(*record).parts.putInto(parts);
    }
    return std::make_shared<const PartsCopy>(std::move(parts), Record::of(*records.back()).state);
}

}  // namespace sand::tin
