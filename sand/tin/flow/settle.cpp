// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/flow/settle.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sand/tin/flow/dual_projection.hpp"
#include "sand/tin/flow/erosion.hpp"

namespace sand::tin {
namespace {

struct Extremes {
    double least = 0, greatest = 0;  // [unit]
};

Extremes extremesOf(const VertexSand& layer) {
    Extremes result;
    bool any = false;
    for (std::size_t i = 0; i < layer.stars().size(); ++i) {
        if (layer.stars()[i] > 0) {
            const double height = layer.heights()[i];
            result = any ? Extremes{std::min(result.least, height), std::max(result.greatest, height)}
                         : Extremes{height, height};
            any = true;
        }
    }
    return result;
}

/// Returns the volume at which the vertex's height is `extreme`. Rounds it towards `inside`, so that the quotient
/// volume / star does not round beyond the extreme.
std::int64_t volumeAt(const VertexSand& layer, Vertex vertex, double extreme, double inside) {
    const double volume = extreme * static_cast<double>(layer.stars()[index(vertex)]);
    // An extreme of one vertex, over the star of another one, may exceed 64 bits. No vertex has more than 2^62.
    const double within = std::clamp(std::nextafter(volume, inside), -0x1p62, 0x1p62);
    return static_cast<std::int64_t>(inside < 0 ? std::floor(within) : std::ceil(within));
}

/// Returns the volume by which a vertex exceeds the extremes [volume unit]. It is negative if the vertex is too low.
std::int64_t overOf(const VertexSand& layer, Vertex vertex, const Extremes& extremes) {
    const double height = layer.heights()[index(vertex)];
    const std::int64_t volume = layer.volumes()[index(vertex)];
    if (height > extremes.greatest) {
        return volume - volumeAt(layer, vertex, extremes.greatest, -HUGE_VAL);
    }
    return height < extremes.least ? volume - volumeAt(layer, vertex, extremes.least, HUGE_VAL) : 0;
}

std::vector<Vertex> besideOf(const VertexSand& layer, Vertex vertex) {
    std::vector<Vertex> beside;
    aroundVertex(layer.triangles(), vertex, [&](std::int32_t slot, int) {
        const Triangle& triangle = layer.triangles().triangles[index(slot)];
        if (triangle.isGround()) {
            std::copy_if(triangle.corner.begin(), triangle.corner.end(), std::back_inserter(beside),
                         [&](Vertex corner) { return corner != vertex; });
        }
    });
    std::sort(beside.begin(), beside.end());
    beside.erase(std::unique(beside.begin(), beside.end()), beside.end());
    return beside;
}

/// Gives the surplus `over` to the neighbours: first evenly, as far as they have room, then as much as each has room
/// left. The rest is shared evenly without regard to room, and the neighbours share it in their turn. Returns false,
/// and stops, at a volume that a vertex cannot hold.
bool share(VertexSand& layer, Vertex vertex, std::int64_t over, const Extremes& extremes) {
    const std::vector<Vertex> beside = besideOf(layer, vertex);
    if (!layer.hasRoom(vertex, -over)) {
        return false;
    }
    layer.add(vertex, -over);
    for (const int turn : {0, 1, 2}) {
        for (std::size_t i = 0; i < beside.size() && over != 0; ++i) {
            std::int64_t part = turn == 1 ? over : over / static_cast<std::int64_t>(beside.size() - i);
            if (turn < 2) {
                const std::int64_t volume = layer.volumes()[index(beside[i])];
                const std::int64_t room =
                    over > 0
                        ? std::max<std::int64_t>(volumeAt(layer, beside[i], extremes.greatest, -HUGE_VAL) - volume, 0)
                        : std::min<std::int64_t>(volumeAt(layer, beside[i], extremes.least, HUGE_VAL) - volume, 0);
                part = over > 0 ? std::min(part, room) : std::max(part, room);
            }
            if (!layer.hasRoom(beside[i], part)) {
                return false;
            }
            layer.add(beside[i], part);
            over -= part;
        }
    }
    return true;
}

/// Lets vertices beyond the extremes share their surplus with their neighbours. The projection may end a little beyond
/// the extremes, because it stops before it is exact. Returns false if a vertex is still beyond them after 64 rounds,
/// or cannot hold its share.
bool keepWithin(VertexSand& layer, const Extremes& extremes) {
    constexpr int kRounds = 64;
    for (int round = 0; round < kRounds; ++round) {
        bool within = true;
        for (std::size_t i = 0; i < layer.stars().size(); ++i) {
            const auto vertex = static_cast<Vertex>(i);
            const std::int64_t over = layer.stars()[i] > 0 ? overOf(layer, vertex, extremes) : 0;
            if (over != 0) {
                within = false;
                if (!share(layer, vertex, over, extremes)) {
                    return false;
                }
            }
        }
        if (within) {
            return true;
        }
    }
    return false;
}

void giveBack(VertexSand& layer, const std::vector<std::int64_t>& volumes) {
    for (std::size_t i = 0; i < volumes.size(); ++i) {
        if (layer.volumes()[i] != volumes[i]) {
            layer.add(static_cast<Vertex>(i), volumes[i] - layer.volumes()[i]);
        }
    }
}

/// Replaces the sand by its projection. Leaves the sand unchanged if the projection does not stay within the extremes,
/// or exceeds kMostSand.
void project(VertexSand& layer, double slope, Rim rim, WorkLimit* limit, Settled& result) {
    const Extremes extremes = extremesOf(layer);  // rim vertices from which sand falls are at 0 already
    const std::vector<std::int64_t> before = layer.volumes();
    DualProjection projection(layer, slope, rim);
    const int iterations = projection.run(limit);
    std::int64_t outflow = 0;
    for (const auto& [vertex, gain] : projection.gains()) {
        layer.add(vertex, gain);
        outflow -= gain;
    }
    if (!keepWithin(layer, extremes) || layer.magnitude() > kMostSand) {
        giveBack(layer, before);
        return;
    }
    result.iterations = iterations;
    result.outflow += outflow;
}

}  // namespace

std::int64_t workOfSweep(const VertexSand& layer) {
    constexpr std::int64_t kCellsPerVertex = 16;  // a vertex takes 14 ns, and a cell 0.8 to 1
    return kCellsPerVertex * layer.mesh().vertexCount();
}

Settled settle(VertexSand& layer, std::int32_t threshold, std::int32_t startThreshold, int most, Rim rim,
               WorkLimit* limit) {
    const std::vector<std::int64_t> before = layer.volumes();
    const std::vector<std::uint8_t> moving = layer.moving();
    Settled result;
    std::vector<Vertex> moved;
    Erosion erosion(layer, threshold, startThreshold, rim);
    result.sweeps = erosion.settle(layer, std::min(most, 1), moved);
    if (!erosion.settled() && most > 1) {
        project(layer, slopesOf(threshold, threshold).slide, rim, limit, result);
        erosion.changeThresholds(threshold, threshold);
        const std::int64_t left = limit == nullptr ? most : limit->left() / workOfSweep(layer);
        result.sweeps += erosion.settle(layer, static_cast<int>(std::min<std::int64_t>(left, most - 1)), moved);
    }
    result.atRest = erosion.settled();
    result.outflow += erosion.takeOutflow();
    if (limit == nullptr || result.atRest) {
        layer.stopMoving();
    }
    for (std::size_t i = 0; i < before.size(); ++i) {
        if (layer.volumes()[i] != before[i] || (moving[i] | layer.moving()[i]) != 0) {
            result.moved.push_back(static_cast<Vertex>(i));
        }
    }
    return result;
}

}  // namespace sand::tin
