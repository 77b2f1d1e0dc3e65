// SPDX-License-Identifier: Apache-2.0
#include "sand/tool.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace sand {
namespace {

constexpr std::int32_t kHalfCell = kProbePerCell / 2;
constexpr std::int32_t kUnitsPerProbe = kUnitsPerCell / kProbePerCell;

/// Horizontal offset of a cell's centre from the tool's [probe unit].
struct Offset {
    std::int64_t x, y;
    [[nodiscard]] std::int64_t squared() const { return x * x + y * y; }
};

Offset offsetOf(ProbePoint at, int column, int row) {
    return {std::int64_t{column} * kProbePerCell + kHalfCell - at.x,
            std::int64_t{row} * kProbePerCell + kHalfCell - at.y};
}

int cellOf(std::int64_t coordinate /* [probe unit] */) {
    return static_cast<int>(coordinate >> kProbeBits);  // rounds down, below zero too
}

/// A cell that takes some of the sand the tool pushes away.
struct Receiver {
    int column, row;
    std::int64_t weight;
    bool outside;
};

/// The cells in a ring of two cells around the tool. With a drag direction, those ahead, by the cosine of their angle
/// to it; without one, all of them alike. Walls and cells beyond a closed rim do not count; beyond an open one they
/// swallow.
std::vector<Receiver> receivers(const Rect& bounds, Rim rim, const Ground* ground, ProbePoint at, std::int64_t radius,
                                Offset ahead) {
    const std::int64_t outer = radius + 2 * kProbePerCell;
    const bool everywhere = ahead.x == 0 && ahead.y == 0;
    std::vector<Receiver> ring;
    for (int y = cellOf(at.y - outer); y <= cellOf(at.y + outer); ++y) {
        for (int x = cellOf(at.x - outer); x <= cellOf(at.x + outer); ++x) {
            const Offset offset = offsetOf(at, x, y);
            const bool outside = x < bounds.x0 || x >= bounds.x1 || y < bounds.y0 || y >= bounds.y1;
            if (offset.squared() < radius * radius || offset.squared() > outer * outer ||
                (outside && rim == Rim::closed) || (!outside && ground != nullptr && ground->isWall(x, y))) {
                continue;
            }
            // The drag is at most a cell and the ring at most 2^14 cells away: the product stays below 2^32.
            const std::int64_t weight = everywhere ? 1 : offset.x * ahead.x + offset.y * ahead.y;
            if (weight > 0) {
                ring.push_back({x, y, weight, outside});
            }
        }
    }
    return ring;
}

/// Gives `amount` to the receivers by weight. The remainder of the division, fewer units than there are receivers, goes
/// one unit each to the first of them.
std::vector<std::int64_t> shares(const std::vector<Receiver>& ring, std::int64_t amount) {
    std::int64_t total = 0;
    for (const Receiver& receiver : ring) {
        total += receiver.weight;
    }
    std::vector<std::int64_t> result;
    std::int64_t rest = amount;
    for (const Receiver& receiver : ring) {
        // 128 bits: an amount below 2^56 times a weight below 2^32.
        __extension__ using Wide = __int128;
        result.push_back(static_cast<std::int64_t>(static_cast<Wide>(amount) * receiver.weight / total));
        rest -= result.back();
    }
    for (std::size_t i = 0; rest > 0; ++i, --rest) {
        ++result[i];
    }
    return result;
}

}  // namespace

Rect SphereTool::footprint(ProbePoint at, int margin) const {
    return {cellOf(std::int64_t{at.x} - radius_) - margin, cellOf(std::int64_t{at.y} - radius_) - margin,
            cellOf(std::int64_t{at.x} + radius_) + margin + 1, cellOf(std::int64_t{at.y} + radius_) + margin + 1};
}

std::int32_t SphereTool::underside(ProbePoint at, int column, int row) const {
    const std::int64_t height = std::int64_t{radius_} * radius_ - offsetOf(at, column, row).squared();
    if (height <= 0) {
        return Obstacle::kFree;
    }
    // IEEE square root of an exact integer: one right answer everywhere.
    const double root = std::sqrt(static_cast<double>(height));
    const auto under = std::int64_t{at.z} * kUnitsPerProbe - static_cast<std::int64_t>(root * kUnitsPerProbe);
    return static_cast<std::int32_t>(std::clamp<std::int64_t>(under, -kMaxHeight, kMaxHeight));
}

std::int32_t SphereTool::cutTo(const HeightField& field, const Ground* ground, ProbePoint at, int column,
                               int row) const {
    const std::int32_t height = field.height(column, row);
    if (ground == nullptr) {
        return std::min(height, underside(at, column, row));
    }
    return ground->isWall(column, row)
               ? height
               : std::min(height, std::max(underside(at, column, row), ground->bedrock(column, row)));
}

SphereTool::Displacement SphereTool::press(HeightField& field, Rim rim, const Ground* ground, ProbePoint at,
                                           std::int64_t dx, std::int64_t dy) const {
    const Rect cells = footprint(at, 0).clippedTo(field.bounds());
    std::int64_t taken = 0;
    for (int y = cells.y0; y < cells.y1; ++y) {
        for (int x = cells.x0; x < cells.x1; ++x) {
            taken += std::int64_t{field.height(x, y)} - cutTo(field, ground, at, x, y);
        }
    }
    if (taken == 0) {
        return {};
    }
    std::vector<Receiver> ring = receivers(field.bounds(), rim, ground, at, radius_, {dx, dy});
    if (ring.empty()) {  // dragged against a closed rim: it escapes to the sides and behind
        ring = receivers(field.bounds(), rim, ground, at, radius_, {0, 0});
    }
    if (ring.empty()) {  // the tool is larger than the field: there is nowhere to put the sand
        return {};
    }
    const std::vector<std::int64_t> share = shares(ring, taken);
    for (std::size_t i = 0; i < ring.size(); ++i) {
        if (!ring[i].outside && field.height(ring[i].column, ring[i].row) + share[i] > kMaxHeight) {
            return {};  // no room left in 32 bits: the sand stays, and the tool passes through it
        }
    }
    for (int y = cells.y0; y < cells.y1; ++y) {
        for (int x = cells.x0; x < cells.x1; ++x) {
            field.setHeight(x, y, cutTo(field, ground, at, x, y));
        }
    }
    Displacement result{footprint(at, 3).clippedTo(field.bounds()), 0};
    for (std::size_t i = 0; i < ring.size(); ++i) {
        if (ring[i].outside) {
            result.outflow += share[i];
        } else {
            const std::int64_t raised = field.height(ring[i].column, ring[i].row) + share[i];
            field.setHeight(ring[i].column, ring[i].row, static_cast<std::int32_t>(raised));
        }
    }
    return result;
}

SphereTool::Displacement SphereTool::drag(HeightField& field, Rim rim, const Ground* ground, ProbePoint from,
                                          ProbePoint to) const {
    const std::int64_t dx = std::int64_t{to.x} - from.x;
    const std::int64_t dy = std::int64_t{to.y} - from.y;
    const std::int64_t dz = std::int64_t{to.z} - from.z;
    const std::int64_t longest = std::max({std::abs(dx), std::abs(dy), std::abs(dz)});
    const std::int64_t steps = std::max<std::int64_t>((longest + kProbePerCell - 1) / kProbePerCell, 1);
    Displacement all{{field.columns(), field.rows(), 0, 0}, 0};
    for (std::int64_t i = 1; i <= steps; ++i) {
        const ProbePoint at{static_cast<std::int32_t>(from.x + dx * i / steps),
                            static_cast<std::int32_t>(from.y + dy * i / steps),
                            static_cast<std::int32_t>(from.z + dz * i / steps)};
        if (footprint(at, 0).clippedTo(field.bounds()).empty()) {
            continue;
        }
        // A direction in whole probe units of one sub-step would lose its angle when the hand is slow.
        const std::int64_t scale = std::max<std::int64_t>(longest / kProbePerCell, 1);
        const Displacement one = press(field, rim, ground, at, dx / scale, dy / scale);
        if (!one.cells.empty()) {
            all.cells = {std::min(all.cells.x0, one.cells.x0), std::min(all.cells.y0, one.cells.y0),
                         std::max(all.cells.x1, one.cells.x1), std::max(all.cells.y1, one.cells.y1)};
        }
        all.outflow += one.outflow;
    }
    return all;
}

Obstacle SphereTool::obstacle(const HeightField& field, ProbePoint at) const {
    Obstacle result;
    result.cells = footprint(at, 0).clippedTo(field.bounds());
    for (int y = result.cells.y0; y < result.cells.y1; ++y) {
        for (int x = result.cells.x0; x < result.cells.x1; ++x) {
            result.underside.push_back(underside(at, x, y));
        }
    }
    return result;
}

}  // namespace sand
