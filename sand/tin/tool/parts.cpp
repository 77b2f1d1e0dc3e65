// SPDX-License-Identifier: Apache-2.0
// One sub-step of a tool beside a hole: each part of the ground around the tool shares out its own sand.
#include <algorithm>
#include <iterator>
#include <optional>
#include <tuple>
#include <utility>

#include "sand/tin/tool/displacement.hpp"

namespace sand::tin {

Vertex Displacement::partOf(Vertex vertex) {
    if (index(vertex) >= up_.size() || up_[index(vertex)] == kNoNumber) {
        return kNoNumber;
    }
    while (up_[index(vertex)] != vertex) {
        vertex = up_[index(vertex)] = up_[index(up_[index(vertex)])];  // shortens the path for the next call
    }
    return vertex;
}

/// Returns the part of a receiver. A place beyond the rim belongs to the part of the nearest vertex. If several are as
/// near, the southernmost counts, and then the westernmost.
Vertex Displacement::partOf(const VertexSand& layer, const Receiver& receiver) {
    if (receiver.vertex != kNoNumber) {
        return partOf(receiver.vertex);
    }
    const auto key = [&](Vertex vertex) {
        const LatticePoint& place = layer.triangles().places[index(vertex)];
        const std::int64_t x = std::int64_t{place.x} - receiver.place.x, y = std::int64_t{place.y} - receiver.place.y;
        return std::tuple(x * x + y * y, place.y, place.x);
    };
    const auto nearest =
        std::min_element(inParts_.begin(), inParts_.end(), [&](Vertex a, Vertex b) { return key(a) < key(b); });
    return nearest == inParts_.end() ? kNoNumber : partOf(*nearest);
}

/// Finds the vertices that the tool covers or that may take sand, and joins those with a common edge on ground.
void Displacement::findParts(const VertexSand& layer, const ProbePoint& probe) {
    const Triangles& mesh = layer.triangles();
    up_.resize(std::max(up_.size(), mesh.places.size()), kNoNumber);
    for (const Vertex vertex : neighbourhood_->vertices()) {
        const LatticePoint& place = mesh.places[index(vertex)];
        const Offset offset{std::int64_t{place.x} - probe.x, std::int64_t{place.y} - probe.y};
        if (layer.stars()[index(vertex)] > 0 && (turned_.takes(offset) || turned_.covers(offset))) {
            up_[index(vertex)] = vertex;
            inParts_.push_back(vertex);
        }
    }
    for (const std::int32_t slot : neighbourhood_->triangles()) {
        const Triangle& triangle = mesh.triangles[index(slot)];
        for (std::size_t k = 0; !triangle.hole && k < 3; ++k) {
            const Vertex one = partOf(triangle.corner[k]), other = partOf(triangle.corner[(k + 1) % 3]);
            if (one != kNoNumber && other != kNoNumber) {
                up_[index(std::max(one, other))] = std::min(one, other);
            }
        }
    }
}

void Displacement::forgetParts() {
    for (const Vertex vertex : inParts_) {
        up_[index(vertex)] = kNoNumber;
    }
    inParts_.clear();
}

void Displacement::pressInParts(VertexSand& layer, Rim rim, const Press& press, Work& done) {
    findParts(layer, press.probe);
    const std::vector<Cut> cuts = std::exchange(cut_, {});
    const auto receiversOf = [&](bool everywhere) {
        receivers_.clear();
        addReceivers(layer, rim, press, everywhere);
        return std::exchange(receivers_, {});
    };
    const std::vector<Receiver> ahead = receiversOf(press.ahead.x == 0 && press.ahead.y == 0);
    std::optional<std::vector<Receiver>> around;  // found when the receivers ahead of a part first cannot take its sand
    std::vector<Vertex> parts;
    std::transform(cuts.begin(), cuts.end(), std::back_inserter(parts),
                   [&](const Cut& cut) { return partOf(cut.vertex); });
    sortOnce(parts);
    bool refused = false;
    for (const Vertex part : parts) {
        cut_.clear();
        receivers_.clear();
        taken_ = 0;
        for (const Cut& cut : cuts) {
            if (partOf(cut.vertex) == part) {
                cut_.push_back(cut);
                taken_ += cut.taken;
            }
        }
        const auto takeOurs = [&](const std::vector<Receiver>& ring) {
            std::copy_if(ring.begin(), ring.end(), std::back_inserter(receivers_),
                         [&](const Receiver& receiver) { return partOf(layer, receiver) == part; });
        };
        takeOurs(ahead);
        if (deal(layer, false, done)) {
            continue;
        }
        receivers_.clear();
        if (!around) {
            around = receiversOf(true);
        }
        takeOurs(*around);
        if (receivers_.empty()) {  // no vertex is near enough, because the mesh is coarse
            addNeighbours(layer, press.probe, [&](Vertex vertex) { return partOf(vertex) == part; });
        }
        refused = !deal(layer, true, done) || refused;
    }
    done.refused += refused ? 1 : 0;
    forgetParts();
}

}  // namespace sand::tin
