// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/volume/vertex_sand.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>

#include "sand/tin/mesh/neighbourhood.hpp"
#include "sand/tin/volume/remap.hpp"

namespace sand::tin {
namespace {

constexpr std::int64_t kVolumeLimit = std::int64_t{1} << 62;
constexpr unsigned kHeightLimitBits = 32;  // every |height| is at most 2^32 [unit]

Wide magnitudeOf(Wide volume) { return volume < 0 ? -volume : volume; }

std::size_t at(Vertex vertex) { return static_cast<std::size_t>(vertex); }

double quotient(std::int64_t volume, std::int64_t star) {
    constexpr std::int64_t kExact = std::int64_t{1} << 53;
    if (volume > -kExact && volume < kExact) {
        return static_cast<double>(volume) / static_cast<double>(star);
    }
    // With whole part and remainder, a level surface stays level although its volumes exceed the exact integers of a
    // double.
    const std::int64_t whole = volume / star;
    return static_cast<double>(whole) + static_cast<double>(volume % star) / static_cast<double>(star);
}

}  // namespace

VertexSand::VertexSand(Mesh mesh) : mesh_(std::move(mesh)) {
    if (!mesh_.hasOutline()) {
        throw std::invalid_argument("holes without their outline");
    }
    (void)mesh_.takeDifference();
    const Triangles& triangles = mesh_.triangles();
    volumes_.resize(triangles.places.size(), 0);
    stars_.resize(triangles.places.size(), 0);
    heights_.resize(triangles.places.size(), 0);
    moving_.resize(triangles.places.size(), 0);
    for (const Triangle& triangle : triangles.triangles) {
        if (triangle.isGround()) {
            const auto& [a, b, c] = triangle.corner;
            const std::int64_t area =
                doubledArea(triangles.places[at(a)], triangles.places[at(b)], triangles.places[at(c)]);
            for (const Vertex corner : triangle.corner) {
                stars_[at(corner)] += area;
            }
        }
    }
}

void VertexSand::reserve(std::size_t vertices) {
    mesh_.reserve(vertices);
    volumes_.reserve(vertices);
    stars_.reserve(vertices);
    heights_.reserve(vertices);
    moving_.reserve(vertices);
}

Wide VertexSand::ground() const { return std::accumulate(stars_.begin(), stars_.end(), Wide{0}); }

Wide VertexSand::volume() const {
    Wide sum = 0;
    for (const std::int64_t volume : volumes_) {  // 0 for a number without a vertex
        sum += volume;
    }
    return sum;
}

void VertexSand::setVolume(Vertex vertex, std::int64_t volume) {
    magnitude_ += magnitudeOf(volume) - magnitudeOf(volumes_[at(vertex)]);
    volumes_[at(vertex)] = volume;
    heights_[at(vertex)] = stars_[at(vertex)] == 0 ? 0 : quotient(volume, stars_[at(vertex)]);
}

bool VertexSand::hasRoom(Vertex vertex, std::int64_t volume) const {
    std::int64_t sum = 0;
    return !__builtin_add_overflow(volumes_[at(vertex)], volume, &sum) && sum < kVolumeLimit && sum > -kVolumeLimit;
}

void VertexSand::add(Vertex vertex, std::int64_t volume) {
    if (!hasRoom(vertex, volume)) {
        throw std::overflow_error("too much sand on vertex " + std::to_string(vertex));
    }
    setVolume(vertex, volumes_[at(vertex)] + volume);
}

void VertexSand::setHeight(Vertex vertex, std::int32_t height) {
    const Wide volume = static_cast<Wide>(stars_[at(vertex)]) * height;
    if (volume >= kVolumeLimit || volume <= -kVolumeLimit) {
        throw std::overflow_error("too much sand on vertex " + std::to_string(vertex));
    }
    setVolume(vertex, static_cast<std::int64_t>(volume));
}

void VertexSand::stopMoving() { std::fill(moving_.begin(), moving_.end(), std::uint8_t{0}); }

Vertex VertexSand::insert(LatticePoint place) {
    const Vertex vertex = mesh_.insert(place);
    remap();
    return vertex;
}

bool VertexSand::remove(Vertex vertex) {
    const bool removed = mesh_.remove(vertex);
    remap();
    return removed;
}

std::vector<Vertex> VertexSand::constrain(Vertex from, Vertex to) {
    std::vector<Vertex> path = mesh_.constrain(from, to).vertices;
    remap();
    return path;
}

void VertexSand::release(Vertex a, Vertex b) {
    mesh_.release(a, b);
    remap();
}

std::vector<Vertex> VertexSand::edit(const std::function<void(Mesh&)>& edits) {
    const auto before = static_cast<std::ptrdiff_t>(remapped_.size());
    try {
        edits(mesh_);
    } catch (...) {
        remap();
        throw;
    }
    remap();
    std::vector<Vertex> changed(remapped_.begin() + before, remapped_.end());
    sortOnce(changed);
    return changed;
}

void VertexSand::remap() {
    Mesh::Difference difference = mesh_.takeDifference();
    if (const Holes* holes = mesh_.holes().get(); holes != nullptr) {
        const auto isHole = [holes](const Mesh::Piece& piece) {
            return holes->holds(piece.place[0], piece.place[1], piece.place[2]);
        };
        std::erase_if(difference.removed, isHole);
        std::erase_if(difference.added, isHole);
    }
    if (difference.added.empty()) {
        return;
    }
    Remapped result = remapVolumes(difference, {volumes_, stars_, heights_, moving_});
    const Wide most = std::max<Wide>(magnitude_, kMostSand);
    const std::size_t count = mesh_.triangles().places.size();
    volumes_.resize(count, 0);
    stars_.resize(count, 0);
    heights_.resize(count, 0);
    moving_.resize(count, 0);
    for (const Vertex vertex : result.removed) {
        setVolume(vertex, 0);
        stars_[at(vertex)] = 0;
        heights_[at(vertex)] = 0;
        moving_[at(vertex)] = 0;
        remapped_.push_back(vertex);
    }
    levelPieces(result, [](const Remapped::Share& share) {
        return magnitudeOf(share.volume) < kVolumeLimit && magnitudeOf(share.volume) <= static_cast<Wide>(share.star)
                                                                                            << kHeightLimitBits;
    });
    take(result);
    if (magnitude_ > most) {
        // A level piece has the least magnitude that its volume allows, so that the sum is not larger than before.
        levelPieces(result, [](const Remapped::Share&) { return false; });
        take(result);
    }
    for (const Remapped::Share& share : result.shares) {
        remapped_.push_back(share.vertex);
        const double moved = std::abs(heights_[at(share.vertex)] - share.before);
        if (moved >= largest_.moved) {
            largest_ = {moved, share.bound};
        }
    }
}

double VertexSand::heightAt(const Located& found) const {
    const Triangle& triangle = triangles().triangles[index(found.triangle)];
    double sum = 0, weights = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto weight = static_cast<double>(found.weights[k]);
        sum += weight * heights_[at(triangle.corner[k])];
        weights += weight;
    }
    return sum / weights;
}

void VertexSand::take(const Remapped& result) {
    for (const Remapped::Share& share : result.shares) {
        if (magnitudeOf(share.volume) >= kVolumeLimit) {  // possible only if the sand before was beyond the limits
            throw std::overflow_error("too much sand on vertex " + std::to_string(share.vertex));
        }
        stars_[at(share.vertex)] = share.star;
        moving_[at(share.vertex)] = share.moves ? 1 : 0;
        setVolume(share.vertex, static_cast<std::int64_t>(share.volume));
    }
}

VertexSand::Remap VertexSand::takeLargestRemap() { return std::exchange(largest_, {}); }

Mesh::Change VertexSand::takeChange() {
    // A remap adds every vertex that changes to `remapped_`. The exceptions are vertices in holes and those of a new
    // mesh, so that the mesh must then list them.
    const bool knows = knowsChange_ && mesh_.holes() == nullptr;
    knowsChange_ = true;
    Mesh::Change change = knows ? mesh_.takeChangeOfTriangles() : mesh_.takeChange();
    change.vertices.insert(change.vertices.end(), remapped_.begin(), remapped_.end());
    sortOnce(change.vertices);
    remapped_.clear();
    return change;
}

}  // namespace sand::tin
