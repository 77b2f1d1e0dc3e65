// SPDX-License-Identifier: Apache-2.0
// One sub-step of a tool: sand above its underside goes to the vertices beside it.
#include <algorithm>
#include <cstdlib>

#include "sand/tin/tool/displacement.hpp"

namespace sand::tin {
namespace {

constexpr Volume kMostOfVertex = (Volume{1} << 62) - 1;  // of one vertex, of either sign
constexpr int kSquaresBeyond = 16;  // lattice squares per tool radius, for the ground beyond an open rim

Offset offsetFrom(const LatticePoint& place, const ProbePoint& probe) {
    return {std::int64_t{place.x} - probe.x, std::int64_t{place.y} - probe.y};
}

Volume floorDivided(Volume value, Volume by) { return value / by - (value % by < 0 ? 1 : 0); }

}  // namespace

/// Finds the sand that the tool takes out. Returns false if there is no such sand, or if a number would leave its
/// range.
bool Displacement::findCut(const VertexSand& layer, const ProbePoint& probe) {
    cut_.clear();
    taken_ = 0;
    const CellRect cells = turned_.cellsAround(probe.x, probe.y, 0);
    const Box box{cells.x0 * kProbePerCell, cells.y0 * kProbePerCell, cells.x1 * kProbePerCell,
                  cells.y1 * kProbePerCell};
    for (const Vertex vertex : neighbourhood_->vertices()) {
        const auto index = static_cast<std::size_t>(vertex);
        const LatticePoint place = layer.triangles().places[index];
        if (!box.holds(place)) {
            continue;
        }
        const std::int32_t underside = turned_.underside(probe.z, offsetFrom(place, probe));
        if (underside == TurnedShape::kFree) {
            continue;
        }
        const Volume target = Volume{underside} * layer.stars()[index];
        const std::int64_t volume = layer.volumes()[index];
        if (volume <= target) {
            continue;
        }
        if (target < -kMostOfVertex) {
            return false;
        }
        cut_.push_back({vertex, static_cast<std::int64_t>(volume - target)});  // both are below 2^62
        taken_ += cut_.back().taken;
    }
    return !cut_.empty();
}

/// Adds the vertices, and the ground beyond an open rim, that take sand ahead of the tool or, with `everywhere`, around
/// it.
void Displacement::addReceivers(const VertexSand& layer, Rim rim, const Press& press, bool everywhere) {
    for (const Vertex vertex : neighbourhood_->vertices()) {
        const auto index = static_cast<std::size_t>(vertex);
        const Offset offset = offsetFrom(layer.triangles().places[index], press.probe);
        if (!turned_.takes(offset) || turned_.covers(offset)) {
            continue;
        }
        const std::int64_t part = everywhere ? 1 : turned_.share(offset, press.ahead);
        if (part > 0 && layer.stars()[index] > 0) {
            receivers_.push_back({vertex, static_cast<double>(part) * static_cast<double>(layer.stars()[index]), {}});
        }
    }
    if (rim == Rim::open) {
        addBeyond(layer, press, everywhere);
    }
}

/// Adds the ground beyond the rim as receivers, as if the field continued there with vertices on a lattice.
void Displacement::addBeyond(const VertexSand& layer, const Press& press, bool everywhere) {
    const Box box = reach(press.probe);
    if (box.clippedTo(layer.triangles()) == box) {
        return;
    }
    const Box field{0, 0, layer.triangles().width, layer.triangles().depth};
    const std::int64_t step = std::max({rules_.spacing, tool_.radius / kSquaresBeyond, 1});
    const double share = 6 * static_cast<double>(step * step);  // star of a vertex of the lattice
    const auto first = [&](std::int32_t least) {                // centres of squares, as in refine()
        return static_cast<std::int64_t>(floorDivided(least, step)) * step + step / 2;
    };
    for (std::int64_t y = first(box.y0); y <= box.y1; y += step) {
        for (std::int64_t x = first(box.x0); x <= box.x1; x += step) {
            const LatticePoint place{static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)};
            const Offset offset = offsetFrom(place, press.probe);
            if (field.holds(place) || !turned_.takes(offset) || turned_.covers(offset)) {
                continue;
            }
            const std::int64_t part = everywhere ? 1 : turned_.share(offset, press.ahead);
            if (part > 0) {
                receivers_.push_back({kNoNumber, static_cast<double>(part) * share, place});
            }
        }
    }
}

/// Adds the neighbours of the vertices below the tool for which `isOurs` is true.
void Displacement::addNeighbours(const VertexSand& layer, const ProbePoint& probe,
                                 const std::function<bool(Vertex)>& isOurs) {
    const auto isCovered = [&](Vertex vertex) {
        return turned_.covers(offsetFrom(layer.triangles().places[static_cast<std::size_t>(vertex)], probe));
    };
    neighbourhood_->look(layer.triangles(), neighbourhood_->box());  // after follow() it has no triangles()
    std::vector<Vertex> beside;
    for (const std::int32_t slot : neighbourhood_->triangles()) {
        const Triangle& triangle = layer.triangles().triangles[static_cast<std::size_t>(slot)];
        const auto& corner = triangle.corner;
        if (!triangle.hole && std::any_of(corner.begin(), corner.end(),
                                          [&](Vertex vertex) { return isCovered(vertex) && isOurs(vertex); })) {
            std::copy_if(corner.begin(), corner.end(), std::back_inserter(beside), std::not_fn(isCovered));
        }
    }
    std::sort(beside.begin(), beside.end());
    beside.erase(std::unique(beside.begin(), beside.end()), beside.end());
    for (const Vertex vertex : beside) {
        receivers_.push_back({vertex, static_cast<double>(layer.stars()[static_cast<std::size_t>(vertex)]), {}});
    }
}

/// Shares `taken_` out among the receivers by weight. Rounding leaves a rest of either sign. It is shared evenly, and
/// its last units go to the receivers with the smallest numbers.
void Displacement::shareOut() {
    double total = 0;
    for (const Receiver& receiver : receivers_) {
        total += receiver.weight;
    }
    const double perWeight = static_cast<double>(taken_) / total;
    Volume rest = taken_;
    for (Receiver& receiver : receivers_) {
        receiver.share = static_cast<Volume>(perWeight * receiver.weight);
        rest -= receiver.share;
    }
    const auto count = static_cast<Volume>(receivers_.size());
    const Volume each = floorDivided(rest, count);
    rest -= each * count;
    for (Receiver& receiver : receivers_) {
        receiver.share += each + (rest > 0 ? 1 : 0);
        rest -= rest > 0 ? 1 : 0;
    }
}

/// Returns whether the sand of a receiver stays within its limits when it gets its share.
bool Displacement::hasRoom(const VertexSand& layer, const Receiver& receiver) const {
    if (receiver.vertex == kNoNumber) {
        return true;
    }
    const Volume raised = layer.volumes()[index(receiver.vertex)] + receiver.share;
    return raised <= std::min(kMostOfVertex, Volume{kMaxHeight} * layer.stars()[index(receiver.vertex)]) &&
           raised >= -kMostOfVertex;
}

/// Returns whether the magnitude of all sand stays within kMostSand when the receivers get their shares.
bool Displacement::isWithinAllSand(const VertexSand& layer) const {
    const auto grown = [&layer](Vertex vertex, Volume by) {
        const Volume before = layer.volumes()[index(vertex)], after = before + by;
        return std::max(after, -after) - std::max(before, -before);
    };
    Volume magnitude = layer.magnitude();
    for (const Cut& cut : cut_) {
        magnitude += grown(cut.vertex, -Volume{cut.taken});
    }
    for (const Receiver& receiver : receivers_) {
        magnitude += receiver.vertex == kNoNumber ? 0 : grown(receiver.vertex, receiver.share);
    }
    return magnitude <= kMostSand;
}

bool Displacement::deal(VertexSand& layer, bool toSome, Work& done) {
    const auto isFull = [&](const Receiver& receiver) { return !hasRoom(layer, receiver); };
    while (!receivers_.empty()) {
        shareOut();
        const auto full = std::remove_if(receivers_.begin(), receivers_.end(), isFull);
        if (full == receivers_.end()) {
            break;
        }
        if (!toSome) {
            return false;
        }
        receivers_.erase(full, receivers_.end());
    }
    if (receivers_.empty() || !isWithinAllSand(layer)) {
        return false;
    }
    for (const Cut& cut : cut_) {
        layer.add(cut.vertex, -cut.taken);
        done.touched.push_back(cut.vertex);
    }
    for (const Receiver& receiver : receivers_) {
        if (receiver.vertex == kNoNumber) {
            done.outflow += receiver.share;
        } else {
            layer.add(receiver.vertex, static_cast<std::int64_t>(receiver.share));
            done.touched.push_back(receiver.vertex);
        }
    }
    return true;
}

bool Displacement::isNearHole(const VertexSand& layer, const Box& box) const {
    const Holes* const holes = layer.mesh().holes().get();
    return holes != nullptr && holes->reachInto({box.x0, box.y0}, {box.x1, box.y1});
}

void Displacement::press(VertexSand& layer, Rim rim, const Press& press, Work& done) {
    if (!findCut(layer, press.probe)) {
        return;
    }
    if (isNearHole(layer, reach(press.probe))) {
        pressInParts(layer, rim, press, done);
        return;
    }
    receivers_.clear();
    addReceivers(layer, rim, press, press.ahead.x == 0 && press.ahead.y == 0);
    if (deal(layer, false, done)) {
        return;
    }
    // Dragged against a closed rim, or into a corner that cannot hold the sand: it escapes to the sides and behind.
    receivers_.clear();
    addReceivers(layer, rim, press, true);
    if (receivers_.empty()) {  // no vertex is near enough, because the mesh is coarse
        addNeighbours(layer, press.probe, [](Vertex) { return true; });
    }
    done.refused += deal(layer, true, done) ? 0 : 1;  // the sand stays, and the tool passes through it
}

}  // namespace sand::tin
