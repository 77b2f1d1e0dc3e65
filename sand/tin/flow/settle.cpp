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

/// The volume at which a vertex lies at an extreme, rounded to the inside: its quotient does not round out again.
std::int64_t volumeAt(const VertexSand& layer, Vertex vertex, double extreme, double inside) {
    const double volume = extreme * static_cast<double>(layer.stars()[index(vertex)]);
    const double within = std::nextafter(volume, inside);
    return static_cast<std::int64_t>(inside < 0 ? std::floor(within) : std::ceil(within));
}

/// How far a vertex lies beyond the extremes: what it has too much, or too little, below 0 [volume unit].
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

/// Shares `over` among the neighbours, first evenly among those that have room for it, then among those that have some
/// left; what there is no room for evenly again: they will share it in turn.
void share(VertexSand& layer, Vertex vertex, std::int64_t over, const Extremes& extremes) {
    const std::vector<Vertex> beside = besideOf(layer, vertex);
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
            layer.add(beside[i], part);
            over -= part;
        }
    }
}

/// What the last iteration left to do may push a vertex past the extremes: it then shares the surplus with its
/// neighbours. False when after some rounds one is still beyond them.
bool keepWithin(VertexSand& layer, const Extremes& extremes) {
    constexpr int kRounds = 64;
    for (int round = 0; round < kRounds; ++round) {
        bool within = true;
        for (std::size_t i = 0; i < layer.stars().size(); ++i) {
            const auto vertex = static_cast<Vertex>(i);
            const std::int64_t over = layer.stars()[i] > 0 ? overOf(layer, vertex, extremes) : 0;
            if (over != 0) {
                within = false;
                share(layer, vertex, over, extremes);
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

/// Replaces the sand by its projection, or leaves it as it is where that is not possible.
void project(VertexSand& layer, double slope, Rim rim, Settled& result) {
    const Extremes extremes = extremesOf(layer);  // a rim from which sand falls is at 0 already
    const std::vector<std::int64_t> before = layer.volumes();
    DualProjection projection(layer, slope, rim);
    const int iterations = projection.run();
    std::int64_t outflow = 0;
    for (const auto& [vertex, gain] : projection.gains()) {
        layer.add(vertex, gain);
        outflow -= gain;
    }
    if (!keepWithin(layer, extremes)) {
        giveBack(layer, before);
        return;
    }
    result.iterations = iterations;
    result.outflow += outflow;
}

}  // namespace

Settled settle(VertexSand& layer, std::int32_t threshold, std::int32_t startThreshold, int most, Rim rim) {
    const std::vector<std::int64_t> before = layer.volumes();
    Settled result;
    std::vector<Vertex> moved;
    Erosion erosion(layer, threshold, startThreshold, rim);
    result.sweeps = erosion.settle(layer, std::min(most, 1), moved);
    if (!erosion.settled() && most > 1) {
        project(layer, slopesOf(threshold, threshold).slide, rim, result);
        erosion.changeThresholds(threshold, threshold);
        result.sweeps += erosion.settle(layer, most - 1, moved);
    }
    result.atRest = erosion.settled();
    result.outflow += erosion.takeOutflow();
    for (std::size_t i = 0; i < before.size(); ++i) {
        if (layer.volumes()[i] != before[i]) {
            result.moved.push_back(static_cast<Vertex>(i));
        }
    }
    return result;
}

}  // namespace sand::tin
