// SPDX-License-Identifier: Apache-2.0
#include "sand/grid/surface.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <span>
#include <utility>

#include "sand/grid/coarse_level.hpp"
#include "sand/grid/record.hpp"
#include "sand/grid/settle.hpp"
#include "sand/model/grid_codec.hpp"

namespace sand::grid {
namespace {

constexpr int kBlock = Erosion::kDefaultBlock;  // [cell], side of the blocks that takeChange() returns

int blocksFor(int cells) { return (cells + kBlock - 1) / kBlock; }

Erosion::Options withGround(Erosion::Options options, const Ground* ground) {
    options.ground = ground;
    return options;
}

}  // namespace

GridSurface::GridSurface(const Rules& rules, HeightField field, std::shared_ptr<const Ground> ground,
                         const Erosion::Options& options, std::shared_ptr<const base::Bytes> start)
    : rules_(rules),
      ground_(std::move(ground)),
      field_(std::move(field)),
      how_(options),
      erosion_(field_, rules_, withGround(options, ground_.get())),
      hash_(field_),
      start_(start != nullptr ? std::move(start) : packedCells(field_.cells(), field_.bounds())) {
    movement_.moved.assign(static_cast<std::size_t>(hash_.tileCount()), 0);
}

std::unique_ptr<Surface> GridSurface::clone() const {
    auto copy = std::make_unique<GridSurface>(*this);
    copy->changed_.reset();  // the copy's first takeChange() returns a whole change
    return copy;
}

void GridSurface::willChange(const CellRect& cells) {
    willChangeHeights(cells);
    completeCopiesOf(cells);
}

void GridSurface::willChangeHeights(const CellRect& cells) {
    if (!beforeStroke_.any() && followed_.now().empty()) {
        return;
    }
    const TileGrid grid(field_.bounds());
    grid.forEach(cells, [&](std::size_t tile) {
        std::shared_ptr<const PackedCells> packed;  // once for all that need it
        const auto pack = [&] {
            if (packed == nullptr) {
                packed = std::make_shared<const PackedCells>(field_.cells(), grid.cellsOf(tile));
            }
            return packed;
        };
        beforeStroke_.willChangeTile(tile, pack);
        for (const std::shared_ptr<SurfaceRecord>& record : followed_.now()) {
            Record::of(*record).willChangeTile(tile, pack);
        }
    });
}

void GridSurface::willBecome(const HeightField& field) {
    if (beforeStroke_.any() || !followed_.now().empty()) {
        const TileGrid grid(field_.bounds());
        for (std::size_t tile = 0; tile < grid.count(); ++tile) {
            const CellRect cells = grid.cellsOf(tile);
            bool differs = false;
            for (int y = cells.y0; y < cells.y1 && !differs; ++y) {
                differs = !std::equal(field.row(y) + cells.x0, field.row(y) + cells.x1, field_.row(y) + cells.x0);
            }
            if (differs) {
                willChangeHeights(cells);
            }
        }
    }
    completeCopiesOf(field_.bounds());
}

void GridSurface::completeCopiesOf(const CellRect& cells) const {
    begun_.forEach([&](TileCopy& copy) {
        copy.willChange(field_, erosion_, cells);
        return true;
    });
}

void GridSurface::forgetEqual() {
    for (const std::shared_ptr<SurfaceRecord>& record : followed_.now()) {
        Record::of(*record).forgetEqual(field_);
    }
}

void GridSurface::touch(const CellRect& cells) {
    if (cells.empty()) {
        return;
    }
    hash_.touch(cells);
    if (changed_) {
        changed_->add({cells.x0 / kBlock, cells.y0 / kBlock, blocksFor(cells.x1), blocksFor(cells.y1)});
    }
}

void GridSurface::touchAll() {
    changed_.reset();
    touch(field_.bounds());
}

SurfaceChange GridSurface::takeChange() {
    if (!changed_) {
        changed_.emplace(blocksFor(field_.columns()), blocksFor(field_.rows()));
        return {};
    }
    CellChange change{changed_->takeRuns()};
    for (CellRect& run : change.cells) {
        run = CellRect{run.x0 * kBlock, run.y0 * kBlock, run.x1 * kBlock, run.y1 * kBlock}.clippedTo(field_.bounds());
    }
    return {.whole = false, .parts = std::move(change)};
}

void GridSurface::drag(const Tool& tool, std::span<const ProbePoint> whole) {
    const Displacement displacement(tool);
    const std::vector<ProbePoint> path = pathInSubsteps({whole.begin(), whole.end()}, substepOnGrid(tool));
    // Searches take at most as long as the longest path.
    std::int64_t searches = std::max<std::int64_t>(rules_.mostSubsteps() / Displacement::kMostTrials, 1);
    for (std::size_t i = 1; i < path.size(); ++i) {
        willChange(displacement.cellsChanged(field_, path[i - 1], path[i]));
        const Displacement::Work done =
            displacement.drag(field_, rules_.rim, ground_.get(), path[i - 1], path[i], !refused_.first, searches);
        searches -= done.searches;
        erosion_.touch(done.cells);
        touch(done.cells);
        outflow_ += done.outflow;
        refused_.count += done.refused;
        if (done.largest) {
            refused_.first = {tool, done.largest};
        }
    }
}

void GridSurface::release(const Tool& tool, const ProbePoint& probe) {
    erosion_.touch(Displacement(tool).cells(field_, probe));
}

void GridSurface::arrive(const Tool& tool, const ProbePoint& probe) {
    erosion_.wake(Displacement(tool).cells(field_, probe));
}

void GridSurface::slideCoarsely(const CellRect& way, const Tool* tool, const ProbePoint& probe) {
    const SweepPlan plan = rules_.sweepPlan();
    const Displacement displacement(tool == nullptr ? rules_.tuning.tool : *tool);
    const CellRect patch = way.grownBy(displacement.reachOfCoarsePhase()).clippedTo(field_.bounds());
    if (patch.empty()) {
        return;
    }
    willChange(patch.grownBy(plan.coarsest).clippedTo(field_.bounds()));
    const Obstacle here = tool == nullptr ? Obstacle{} : displacement.obstacle(field_, probe);
    const CoarseLevel::Site site{field_, rules_, ground_.get(), here.cells.empty() ? nullptr : &here, how_};
    for (int side = plan.coarsest; side >= plan.finest; side /= 2) {
        const CoarseLevel::Result slid = CoarseLevel(site, patch, side).sweep(plan.sweepsOf(side));
        outflow_ += slid.outflow;
        if (!slid.changed.empty()) {
            erosion_.touch(slid.changed);
            touch(slid.changed);
        }
    }
}

Swept GridSurface::sweep(const SweepPart& part, const Tool* tool, const ProbePoint& probe) {
    const Obstacle here = tool == nullptr ? Obstacle{} : Displacement(*tool).obstacle(field_, probe);
    const std::int64_t before = erosion_.sweepsDone();
    std::function<void(const CellRect&)> changes;
    if (beforeStroke_.any() || begun_.any() || !followed_.now().empty()) {
        changes = [this](const CellRect& cells) { willChange(cells); };
    }
    const Erosion::Swept swept = erosion_.sweep(field_, part, tool == nullptr ? nullptr : &here, changes);
    outflow_ += swept.outflow;
    for (const CellRect& block : erosion_.takeMoved()) {
        touch(block);
    }
    return {erosion_.sweepsDone() - before, swept.still};
}

void GridSurface::changeRules(const Rules& rules) {
    rules_ = rules;
    // Wakes all sand: it may be too steep now, or a larger tool may have held it back.
    erosion_.changeRules(rules_);
}

bool GridSurface::settle() {
    willChange(field_.bounds());
    WorkLimit limit(mostSettlingWork());
    const Settled settled = sand::grid::settle(field_, rules_, nullptr, base::fastestCodePath(), &limit);
    outflow_ += settled.outflow;
    forgetEqual();
    erosion_.touch(field_.bounds());
    touchAll();
    return settled.atRest;
}

void GridSurface::reset() {
    willChange(field_.bounds());
    base::ByteReader reader(*start_);
    decodeCells(reader, field_.bounds(), kMaxHeight, field_.cells());
    forgetEqual();
    erosion_.resume({});
    outflow_ = 0;
    touchAll();
    (void)followed_.restored();
}

void GridSurface::putBackKept() {
    completeCopiesOf(field_.bounds());  // all fluxes change, but only the heights of the stroke
    const std::vector<CellRect> changed = beforeStroke_.changed();
    for (const CellRect& tile : changed) {
        willChangeHeights(tile);
    }
    beforeStroke_.putBackHeights(field_);
    for (const CellRect& tile : changed) {
        touch(tile);
    }
    erosion_.resume(beforeStroke_.inertia());
    outflow_ = beforeStroke_.outflow();
    (void)followed_.restored();
}

std::shared_ptr<const SurfaceCopy> GridSurface::copy() const {
    return std::make_shared<const Snapshot>(field_, erosion_.inertia(), outflow_);
}

Surface::Copies GridSurface::beginCopy() const {
    const auto sand = std::make_shared<TileCopy>(field_, erosion_, outflow_);
    begun_.begin(sand);
    return {sand, hasKept() ? std::make_shared<const KeptCopy>(beforeStroke_, sand) : nullptr};
}

bool GridSurface::continueCopy(std::int64_t cells) const {
    bool copied = false;
    begun_.forEach([&](TileCopy& copy) {
        copy.copyMore(field_, erosion_, cells);
        copied = true;
        return false;
    });
    return copied;
}

std::shared_ptr<SurfaceRecord> GridSurface::record() {
    auto record = std::make_shared<Record>(TileGrid(field_.bounds()).count(), erosion_.inertia(), outflow_);
    SurfaceRecords all = followed_.now();
    all.push_back(record);
    followed_.follow(std::move(all));
    return record;
}

std::shared_ptr<SurfaceRecord> GridSurface::recordLike(const SurfaceRecord& parts, const SurfaceRecord* moment) {
    const TileGrid grid(field_.bounds());
    const Record* const then = moment == nullptr ? nullptr : &Record::of(*moment);
    auto like = then == nullptr ? std::make_shared<Record>(grid.count(), erosion_.inertia(), outflow_)
                                : std::make_shared<Record>(grid.count(), then->inertia(), then->outflow());
    for (std::size_t tile = 0; tile < grid.count(); ++tile) {
        if (Record::of(parts).tiles()[tile] != nullptr) {
            const bool has = then != nullptr && then->tiles()[tile] != nullptr;
            like->put(tile, has ? then->tiles()[tile]
                                : std::make_shared<const PackedCells>(field_.cells(), grid.cellsOf(tile)));
        }
    }
    return like;
}

std::shared_ptr<const SurfaceCopy> GridSurface::beginCopyOf(const SurfaceRecords& records) {
    const auto now = std::make_shared<TileCopy>(field_, erosion_, outflow_);
    begun_.begin(now);
    KeptCopy::Tiles tiles = Record::of(*records.front()).tiles();
    for (const std::shared_ptr<SurfaceRecord>& record : records) {
        const KeptCopy::Tiles& own = Record::of(*record).tiles();
        for (std::size_t tile = 0; tile < own.size(); ++tile) {
            tiles[tile] = own[tile] != nullptr ? own[tile] : tiles[tile];
        }
    }
    const Record& last = Record::of(*records.back());
    return std::make_shared<const KeptCopy>(std::move(tiles), last.inertia(), last.outflow(), now);
}

SurfaceReader GridSurface::reader() const {
    const FieldFaces faces{field_.columns(), field_.rows(), rules_.rim, rules_.aspect};
    return [faces, cellSize = field_.cellSize(),
            ground = ground_](std::span<const std::uint8_t> bytes) -> std::shared_ptr<const SurfaceCopy> {
        return std::make_shared<const Snapshot>(Snapshot::decode(bytes, {faces, cellSize, ground.get()}));
    };
}

void GridSurface::replace(const SurfaceCopy& copy) {
    const auto& sand = dynamic_cast<const Snapshot&>(copy);
    willBecome(sand.field);
    field_ = sand.field;
    resume({sand.inertia, sand.outflow});
}

void GridSurface::resume(const SandRest& rest) {
    erosion_.resume(rest.inertia);
    outflow_ = rest.outflow;
    touchAll();
    (void)followed_.restored();
}

void GridSurface::encodeInto(base::ByteWriter& writer) const {
    encodeSand(field_.bounds(), [this](int row) { return field_.row(row); }, {erosion_.inertia(), outflow_}, writer,
               {});
}

std::function<void()> GridSurface::decode(std::span<const std::uint8_t> sand, std::span<const std::uint8_t> kept,
                                          const Decoding& how) {
    const SandLimits limits{
        {field_.columns(), field_.rows(), rules_.rim, rules_.aspect}, field_.cellSize(), ground_.get()};
    if (how.inPlace) {
        completeCopiesOf(field_.bounds());
    }
    const auto other =
        how.inPlace ? nullptr : std::make_shared<HeightField>(field_.columns(), field_.rows(), field_.cellSize());
    HeightField& next = how.inPlace ? field_ : *other;
    const auto rest =
        std::make_shared<SandRest>(decodeSand(sand, limits, {[&next](int y) { return next.row(y); }}, how.decoded));
    // The kept sand is decoded now, because at the undo it would be too late to refuse it.
    const auto stroke =
        kept.empty() ? std::make_shared<Undo>() : std::make_shared<Undo>(Undo::decode(kept, limits, next, how.decoded));
    return [this, other, rest, stroke] {
        if (other != nullptr) {
            willBecome(*other);
            field_ = std::move(*other);
        }
        resume(*rest);
        beforeStroke_ = std::move(*stroke);
    };
}

std::uint64_t GridSurface::hash() {
    hash_.update(field_, [](int) {});  // outside steps only a state changes the sand, and it has its own movement
    return hash_.sum();
}

void GridSurface::endStep(std::uint64_t number) {
    movement_.step = number;
    hash_.update(field_, [this](int tile) { movement_.add(tile); });
}

void GridSurface::corruptMovement(int column, int row) {
    const int across = hashTilesAlong(field_.columns());
    movement_.moved[static_cast<std::size_t>(row / kHashTile * across + column / kHashTile)] ^= 1;
}

void GridSurface::audit(int tiles) {
    for (int i = 0; i < std::min(tiles, hash_.tileCount()); ++i) {
        const int tile = hash_.auditNext(field_);
        // A corrupted flux in a block at rest would create sand.
        if (erosion_.amiss(hash_.cellsOf(tile))) {
            hash_.spoil(tile);
        }
    }
}

std::vector<std::int32_t> GridSurface::valuesOf(int tile) const {
    std::vector<std::int32_t> heights;
    const CellRect cells = hash_.cellsOf(tile);
    for (int y = cells.y0; y < cells.y1; ++y) {
        heights.insert(heights.end(), field_.row(y) + cells.x0, field_.row(y) + cells.x1);
    }
    return heights;
}

void GridSurface::corrupt(int column, int row, int bit) {
    completeCopiesOf(
        {column, row, column + 1, row + 1});  // not the undo, because a fault of the memory changes it as well
    field_.setHeight(column, row, field_.height(column, row) ^ (std::int32_t{1} << bit));
}

namespace {

/// Returns the cell at a place, or the nearest one if the place is outside the field.
int cellAt(double place /* [probe unit] */, int cells) {
    return std::clamp(static_cast<int>(std::floor(place / kProbePerCell)), 0, cells - 1);
}

}  // namespace

double GridSurface::height(double x, double y) const {
    return field_.height(cellAt(x, field_.columns()), cellAt(y, field_.rows()));
}

HeightSpan GridSurface::heights() const {
    std::int32_t lowest = field_.height(0, 0), highest = lowest;
    for (int row = 0; row < field_.rows(); ++row) {
        for (const std::int32_t height : std::span(field_.row(row), static_cast<std::size_t>(field_.columns()))) {
            lowest = std::min(lowest, height);
            highest = std::max(highest, height);
        }
    }
    return {static_cast<double>(lowest), static_cast<double>(highest)};
}

std::optional<double> GridSurface::keptHeight(double x, double y) const {
    if (!hasKept()) {
        return std::nullopt;
    }
    return beforeStroke_.height(field_, cellAt(x, field_.columns()), cellAt(y, field_.rows()));
}

}  // namespace sand::grid
