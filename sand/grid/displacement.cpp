// SPDX-License-Identifier: Apache-2.0
#include "sand/grid/displacement.hpp"

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <limits>

#include "sand/grid/surroundings.hpp"
#include "sand/model/tool_kernel.hpp"

namespace sand::grid {
namespace {

/// Cell that takes some of the sand that the tool pushes away.
struct Receiver {
    int column, row;
    std::int64_t weight;
    bool outside;
    std::int64_t share = 0;  // [unit]
};

/// Returns the cells around the tool that take sand. If `ahead` is not zero, these are the cells ahead of the tool. If
/// it is zero, these are all cells around the tool, with equal weights. Wall cells and cells beyond a closed rim take
/// no sand. Sand for cells beyond an open rim leaves the field.
std::vector<Receiver> receivers(const CellRect& bounds, Rim rim, const Ground* ground, ProbePoint probe,
                                const TurnedShape& shape, const Offset& ahead) {
    const bool everywhere = ahead.x == 0 && ahead.y == 0;
    CellRect around = shape.cellsThatTake(probe.x, probe.y);
    if (rim == Rim::closed) {
        around = around.clippedTo(bounds);
    }
    std::vector<Receiver> ring;
    for (int y = around.y0; y < around.y1; ++y) {
        for (int x = around.x0; x < around.x1; ++x) {
            const Offset offset = offsetOf(probe, x, y);
            if (offset.x < 0 && !shape.hasHeading() && shape.covers(offset)) {
                // A round tool covers the row up to the same distance on the other side. The loop skips these cells,
                // because the largest tool covers millions of cells.
                x += static_cast<int>(-2 * offset.x / kProbePerCell);
                continue;
            }
            if (!shape.hasHeading() && !everywhere && shape.share(offset, ahead) <= 0) {
                continue;  // half of the cells are behind, and for a round tool this test is the fastest
            }
            const bool outside = x < bounds.x0 || x >= bounds.x1 || y < bounds.y0 || y >= bounds.y1;
            if ((outside && rim == Rim::closed) || shape.covers(offset) || !shape.takes(offset) ||
                (!outside && ground != nullptr && ground->isWall(x, y))) {
                continue;
            }
            const std::int64_t weight = everywhere ? 1 : shape.share(offset, ahead);
            if (weight > 0) {
                ring.push_back({x, y, weight, outside});
            }
        }
    }
    return ring;
}

/// Returns amount · weight / total, rounded down. All are positive; `amount` is below 2^56 and `weight` below 2^36.
std::int64_t scaled(std::int64_t amount, std::int64_t weight, std::int64_t total) {
    // clang-tidy 14 does not see that every weight in a total is positive. NOLINTBEGIN(clang-analyzer-core.DivideZero)
    std::int64_t product = 0;
    if (!__builtin_mul_overflow(amount, weight, &product)) {
        return product / total;  // nearly always, and several times as fast
    }
    __extension__ using Product = __int128;
    return static_cast<std::int64_t>(static_cast<Product>(amount) * weight / total);
    // NOLINTEND(clang-analyzer-core.DivideZero)
}

/// Gives `amount` to the receivers by weight. The remainder of the division is smaller than the number of receivers.
/// The first receivers get one unit of it each. For a round tool, these are the first by rows. For a tool with a
/// heading, they are the first in an order that turns with the tool.
void shareOut(std::vector<Receiver>& ring, std::int64_t amount, ProbePoint probe, const TurnedShape& shape) {
    std::int64_t total = 0;
    for (const Receiver& receiver : ring) {
        total += receiver.weight;
    }
    std::int64_t rest = amount;
    for (Receiver& receiver : ring) {
        receiver.share = scaled(amount, receiver.weight, total);
        rest -= receiver.share;
    }
    if (shape.hasHeading()) {
        std::nth_element(ring.begin(), ring.begin() + rest, ring.end(), [&](const Receiver& a, const Receiver& b) {
            return shape.before(offsetOf(probe, a.column, a.row), offsetOf(probe, b.column, b.row));
        });
    }
    for (std::size_t i = 0; rest > 0; ++i, --rest) {
        ++ring[i].share;
    }
}

/// Shares out `amount` as shareOut() does. If a height would exceed kMaxHeight, leaves out the cells that are too high
/// with `toSome`. Returns false if no cells can take the sand.
bool deal(const HeightField& field, std::vector<Receiver>& ring, std::int64_t amount, bool toSome, ProbePoint probe,
          const TurnedShape& shape) {
    const auto isFull = [&](const Receiver& receiver) {
        return !receiver.outside && field.height(receiver.column, receiver.row) + receiver.share > kMaxHeight;
    };
    while (!ring.empty()) {
        shareOut(ring, amount, probe, shape);
        if (std::none_of(ring.begin(), ring.end(), isFull)) {
            return true;
        }
        if (!toSome) {
            return false;
        }
        std::erase_if(ring, isFull);
    }
    return false;
}

/// Gives the receivers their shares. Returns the volume that leaves the field.
std::int64_t raise(HeightField& field, const std::vector<Receiver>& ring) {
    std::int64_t outflow = 0;
    for (const Receiver& receiver : ring) {
        if (receiver.outside) {
            outflow += receiver.share;
        } else {
            const std::int64_t raised = field.height(receiver.column, receiver.row) + receiver.share;
            field.setHeight(receiver.column, receiver.row, static_cast<std::int32_t>(raised));
        }
    }
    return outflow;
}

/// Returns the receivers of each part of the surroundings, in the same order.
std::vector<std::vector<Receiver>> divided(const std::vector<Receiver>& ring, const Surroundings& surroundings) {
    std::vector<std::vector<Receiver>> byPart(static_cast<std::size_t>(surroundings.count()));
    for (const Receiver& receiver : ring) {
        const std::int32_t part = surroundings.partOf(receiver.column, receiver.row);
        if (part != Surroundings::kNone) {
            byPart[static_cast<std::size_t>(part)].push_back(receiver);
        }
    }
    return byPart;
}

}  // namespace

CellRect Displacement::cells(const HeightField& field, ProbePoint probe) const {
    return shape_.cellsAround(probe.x, probe.y, 0).clippedTo(field.bounds());
}

void Displacement::findLowest(const Ground* ground, ProbePoint probe, int column, int row,
                              std::span<std::int32_t> lowest) const {
    shape_.undersides(probe.z, offsetOf(probe, column, row), lowest);
    for (std::size_t i = 0; ground != nullptr && i < lowest.size(); ++i) {
        const int x = column + static_cast<int>(i);
        lowest[i] = ground->isWall(x, row) ? TurnedShape::kFree : std::max(lowest[i], ground->bedrock(x, row));
    }
}

Cut Displacement::findCut(const HeightField& field, const Ground* ground, ProbePoint probe) const {
    Cut cut;
    cut.cells = cells(field, probe);
    const auto across = static_cast<std::size_t>(std::max(cut.cells.x1 - cut.cells.x0, 0));
    const auto above = path_ != base::CodePath::baseline ? sand::v3::sandAbove : sand::baseline::sandAbove;
    std::vector<std::int32_t>& lowest = cut.lowest;
    lowest.resize(across);  // room for one row more than the tool cuts
    for (int y = cut.cells.y0; y < cut.cells.y1; ++y) {
        const std::span<std::int32_t> ofRow = std::span(lowest).last(across);
        findLowest(ground, probe, cut.cells.x0, y, ofRow);
        const std::int64_t more = above(ofRow.data(), field.row(y) + cut.cells.x0, cut.cells.x1 - cut.cells.x0);
        if (more > 0) {
            cut.taken += more;
            cut.rows.push_back(y);
            lowest.resize(lowest.size() + across);
        }
    }
    return cut;
}

Displacement::Work Displacement::press(const HeightField& field, HeightField* into, Rim rim, const Ground* ground,
                                       const Press& at) const {
    const auto& [probe, ahead] = at;
    const Cut cut = findCut(field, ground, probe);
    if (cut.taken == 0) {
        return {};
    }
    if (ground != nullptr) {
        const Surroundings surroundings(field, *ground, shape_, probe, cut);
        if (surroundings.barred()) {
            return pressInParts(field, into, rim, *ground, at, cut, surroundings);
        }
    }
    std::vector<Receiver> ring = receivers(field.bounds(), rim, ground, probe, shape_, ahead);
    if (!deal(field, ring, cut.taken, false, probe, shape_)) {
        // Dragged against a closed rim, or the cells ahead have no room: the sand escapes to the sides and behind.
        ring = receivers(field.bounds(), rim, ground, probe, shape_, {0, 0});
        if (!deal(field, ring, cut.taken, true, probe, shape_)) {
            return {.refused = 1};  // the sand stays, and the tool passes through it
        }
    }
    if (into == nullptr) {
        return {};
    }
    for (std::size_t i = 0; i < cut.rows.size(); ++i) {
        std::int32_t* const row = into->row(cut.rows[i]) + cut.cells.x0;
        std::transform(cut.lowestOf(i), cut.lowestOf(i) + cut.across(), row, row,
                       [](std::int32_t least, std::int32_t height) { return std::min(height, least); });
    }
    return {.cells = shape_.cellsChanged(probe.x, probe.y).clippedTo(field.bounds()), .outflow = raise(*into, ring)};
}

Displacement::Work Displacement::pressInParts(const HeightField& field, HeightField* into, Rim rim,
                                              const Ground& ground, const Press& at, const Cut& cut,
                                              const Surroundings& surroundings) const {
    const auto& [probe, ahead] = at;
    const auto ringsOf = [&, from = at.probe](const Offset& way) {
        return divided(receivers(field.bounds(), rim, &ground, from, shape_, way), surroundings);
    };
    std::vector<std::vector<Receiver>> rings = ringsOf(ahead), around;
    std::vector<std::uint8_t> moves(rings.size());
    Work result{.cells = shape_.cellsChanged(probe.x, probe.y).clippedTo(field.bounds())};
    for (std::int32_t part = 0; part < surroundings.count(); ++part) {
        std::vector<Receiver>& ring = rings[static_cast<std::size_t>(part)];
        if (surroundings.taken(part) == 0) {
            continue;
        }
        const std::int64_t taken = surroundings.taken(part);
        if (!deal(field, ring, taken, false, probe, shape_)) {
            if (around.empty()) {
                around = ringsOf({0, 0});
            }
            ring = around[static_cast<std::size_t>(part)];
            if (!deal(field, ring, taken, true, probe, shape_)) {
                result.refused = 1;  // the sand stays, and the tool passes through it
                continue;
            }
        }
        moves[static_cast<std::size_t>(part)] = 1;
        result.outflow += into == nullptr ? 0 : raise(*into, ring);
    }
    if (into == nullptr) {
        return result;
    }
    // Receivers are beside the tool, so that raising them has not changed the cells below it.
    for (std::size_t i = 0; i < cut.rows.size(); ++i) {
        for (int x = cut.cells.x0; x < cut.cells.x1; ++x) {
            const std::int32_t lowest = cut.lowestOf(i)[x - cut.cells.x0], height = field.height(x, cut.rows[i]);
            if (height > lowest && moves[static_cast<std::size_t>(surroundings.partOf(x, cut.rows[i]))] != 0) {
                into->setHeight(x, cut.rows[i], lowest);
            }
        }
    }
    return result;
}

std::int32_t Displacement::largestRadius(const HeightField& field, Rim rim, const Ground* ground,
                                         const Press& at) const {
    std::int32_t fits = 0, refused = tool_.radius / kProbePerCell + 1;  // [cell]
    while (refused - fits > 1) {
        const std::int32_t cells = fits + (refused - fits) / 2, radius = cells * kProbePerCell;
        Tool tool = tool_;
        tool.radius = radius;
        tool.halfWidth = static_cast<std::int32_t>(std::int64_t{tool_.halfWidth} * radius / tool_.radius);
        const bool isRefused = Displacement(tool, path_).press(field, nullptr, rim, ground, at).refused > 0;
        (isRefused ? refused : fits) = cells;
    }
    return fits * kProbePerCell;
}

Displacement::Work Displacement::pressAbove(HeightField& field, Rim rim, const Ground* ground, Press at) const {
    constexpr std::int32_t kAboveAll = kMaxHeight / kUnitsPerProbe + kLargestToolRadius + 1;
    static_assert((std::int64_t{1} << kMostTrials) >=
                  std::int64_t{kMaxProbe} + kAboveAll);  // each trial halves the rest
    std::int32_t& z = at.probe.z;
    std::int32_t refused = z, fits = kMaxHeight / kUnitsPerProbe + tool_.radius + 1;  // above all sand it takes nothing
    while (fits - refused > 1) {
        z = refused + (fits - refused) / 2;
        (press(field, nullptr, rim, ground, at).refused > 0 ? refused : fits) = z;
    }
    z = fits;
    return press(field, &field, rim, ground, at);
}

Displacement::Work Displacement::drag(HeightField& field, Rim rim, const Ground* ground, ProbePoint from, ProbePoint to,
                                      bool measures, std::int64_t mostSearches) const {
    const std::int64_t dx = std::int64_t{to.x} - from.x;
    const std::int64_t dy = std::int64_t{to.y} - from.y;
    const std::int64_t dz = std::int64_t{to.z} - from.z;
    const std::int64_t longest = std::max({std::abs(dx), std::abs(dy), std::abs(dz)});
    const std::int64_t steps = substepsBetween(from, to, substepOnGrid(tool_));
    Work all;
    for (std::int64_t i = 1; i <= steps; ++i) {
        const ProbePoint probe{static_cast<std::int32_t>(from.x + dx * i / steps),
                               static_cast<std::int32_t>(from.y + dy * i / steps),
                               static_cast<std::int32_t>(from.z + dz * i / steps)};
        if (cells(field, probe).empty()) {
            continue;
        }
        // The direction of one sub-step, in whole probe units, would lose its angle if the hand is slow.
        const std::int64_t scale = std::max<std::int64_t>(longest / kProbePerCell, 1);
        const Press at{probe, {dx / scale, dy / scale}};
        const Work one = press(field, &field, rim, ground, at);
        all.add(one);
        if (one.refused > 0) {
            if (measures && !all.largest) {
                all.largest = largestRadius(field, rim, ground, at);  // refused sand has not moved
            }
            if (all.searches < mostSearches) {
                ++all.searches;
                all.add(pressAbove(field, rim, ground, at));
            }
        }
    }
    return all;
}

Obstacle Displacement::obstacle(const HeightField& field, ProbePoint probe) const {
    Obstacle result{cells(field, probe), {}, {}};
    if (result.cells.empty()) {
        return result;
    }
    const CellRect& below = result.cells;
    const int rows = below.y1 - below.y0 + 2 * Obstacle::kRowsBeside;
    result.underside.assign(static_cast<std::size_t>(result.stride()) * static_cast<std::size_t>(rows),
                            Obstacle::kFree);
    const auto across = static_cast<std::size_t>(below.x1 - below.x0);
    for (int y = below.y0; y < below.y1; ++y) {
        const auto first = static_cast<std::size_t>(result.row(y) - result.underside.data());
        const std::span<std::int32_t> row = std::span(result.underside).subspan(first, across);
        shape_.undersides(probe.z, offsetOf(probe, below.x0, y), row);
        std::transform(row.begin(), row.end(), row.begin(), [](std::int32_t from) {
            return from == TurnedShape::kFree ? Obstacle::kFree : std::min(from, kMaxHeight);
        });
    }
    result.findReached();
    return result;
}

void Obstacle::findReached() {
    reached.assign(static_cast<std::size_t>(cells.y1 - cells.y0) + 2, {std::numeric_limits<int>::max(), 0});
    for (int y = cells.y0; y < cells.y1; ++y) {
        const std::int32_t* const first = row(y);
        const std::int32_t* const end = first + (cells.x1 - cells.x0);
        const auto isHeld = [](std::int32_t under) { return under != kFree; };
        const std::int32_t* const held = std::find_if(first, end, isHeld);
        if (held == end) {
            continue;
        }
        const auto last = std::find_if(std::reverse_iterator(end), std::reverse_iterator(first), isHeld).base();
        const int x0 = cells.x0 + static_cast<int>(held - first) - 1,
                  x1 = cells.x0 + static_cast<int>(last - first) + 1;
        for (int beside = 0; beside < 3; ++beside) {
            Columns& columns = reached[static_cast<std::size_t>(y - cells.y0 + beside)];
            columns = {std::min(columns.x0, x0), std::max(columns.x1, x1)};
        }
    }
}

}  // namespace sand::grid
