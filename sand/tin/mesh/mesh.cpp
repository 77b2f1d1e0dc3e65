// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/mesh/mesh.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "sand/tin/mesh/spatial_order.hpp"
#include "sand/tin/mesh/triangulation.hpp"

namespace sand::tin {
namespace {

constexpr std::int32_t kMaxSide = 1 << 22;

std::string toText(const LatticePoint& place) { return std::to_string(place.x) + ", " + std::to_string(place.y); }

}  // namespace

Mesh::Mesh(std::int32_t width, std::int32_t depth, std::shared_ptr<const Holes> holes) {
    if (width < 1 || depth < 1 || width > kMaxSide || depth > kMaxSide) {
        throw std::invalid_argument("a mesh of " + std::to_string(width) + " by " + std::to_string(depth) +
                                    " probe units: each must be within 1 and " + std::to_string(kMaxSide));
    }
    triangulation_ = std::make_unique<Triangulation>(width, depth, std::move(holes));
}

Mesh::~Mesh() = default;
Mesh::Mesh(Mesh&&) noexcept = default;
Mesh& Mesh::operator=(Mesh&&) noexcept = default;

const Triangles& Mesh::triangles() const { return triangulation_->mesh(); }

const std::shared_ptr<const Holes>& Mesh::holes() const { return triangulation_->holes(); }

int Mesh::vertexCount() const { return triangulation_->vertexCount(); }

void Mesh::requireInside(const LatticePoint& place) const {
    const Triangles& mesh = triangles();
    if (place.x < 0 || place.y < 0 || place.x > mesh.width || place.y > mesh.depth) {
        throw std::invalid_argument("a vertex at " + toText(place) + ", outside the field of " +
                                    toText({mesh.width, mesh.depth}));
    }
}

void Mesh::requireAlive(Vertex vertex) const {
    if (!triangles().alive(vertex)) {
        throw std::invalid_argument("no vertex " + std::to_string(vertex));
    }
}

Vertex Mesh::insert(LatticePoint place) {
    requireInside(place);
    return triangulation_->insert(place);
}

std::vector<Vertex> Mesh::insert(std::span<const LatticePoint> places, const std::function<void(double share)>& done) {
    std::for_each(places.begin(), places.end(), [this](const LatticePoint& place) { requireInside(place); });
    const auto [order, first] = spatialOrder(places);
    // First find the vertices that exist already, then give out numbers in the order of `places`, then change the
    // mesh.
    std::vector<Vertex> numbers(places.size(), kNoNumber);
    for (const std::uint32_t index : order) {
        const Located located = triangulation_->find(places[index]);
        if (const std::size_t corner = cornerAt(located); corner < 3) {
            numbers[index] = triangles().triangles[static_cast<std::size_t>(located.triangle)].corner[corner];
        }
    }
    triangulation_->reserve(order.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (first[i] != i) {
            numbers[i] = numbers[first[i]];
        } else if (numbers[i] == kNoNumber) {
            numbers[i] = triangulation_->takeNumber();
        }
    }
    constexpr std::size_t kPlacesPerReport = 4096;
    for (std::size_t i = 0; i < order.size(); ++i) {
        triangulation_->insert(places[order[i]], numbers[order[i]]);
        if (done && i % kPlacesPerReport == 0) {
            done(static_cast<double>(i) / static_cast<double>(order.size()));
        }
    }
    return numbers;
}

void Mesh::reserve(std::size_t vertices) {
    triangulation_->reserve(vertices - std::min(vertices, triangles().places.size()));
}

void Mesh::limitVertices(std::size_t most) { triangulation_->mostVertices = most; }

bool Mesh::remove(Vertex vertex) {
    requireAlive(vertex);
    if (vertex < 4) {
        return false;
    }
    const std::vector<Vertex> along = triangulation_->outlineFrom(vertex);
    if (!along.empty() && !isStraight(vertex, along)) {
        return false;
    }
    triangulation_->remove(vertex);
    if (!along.empty()) {
        triangulation_->constrain(along[0], along[1]);
    }
    return true;
}

bool Mesh::isStraight(Vertex vertex, const std::vector<Vertex>& along) const {
    const auto place = [this](Vertex number) { return triangles().places[static_cast<std::size_t>(number)]; };
    return along.size() == 2 && doubledArea(place(along[0]), place(vertex), place(along[1])) == 0;
}

bool Mesh::hasOutline() const {
    if (holes() == nullptr) {
        return true;
    }
    const auto standsFrom = [this](const Holes::Part& part) {
        const Located located = triangulation_->find(part.from);
        const std::size_t corner = cornerAt(located);
        if (corner == 3) {
            return false;
        }
        Vertex at = triangles().triangles[static_cast<std::size_t>(located.triangle)].corner[corner];
        while (triangles().places[static_cast<std::size_t>(at)] != part.to) {
            at = triangulation_->nextAlong(at, part.to);
            if (at == kNoNumber) {
                return false;
            }
        }
        return true;
    };
    const std::vector<Holes::Part>& outline = holes()->outline();
    return std::all_of(outline.begin(), outline.end(), standsFrom);
}

Mesh::Path Mesh::constrain(Vertex from, Vertex to) {
    requireAlive(from);
    requireAlive(to);
    return from == to ? Path{} : triangulation_->constrain(from, to);
}

void Mesh::takeGroundOut(std::span<const std::int32_t> slots) {
    std::for_each(slots.begin(), slots.end(), [this](std::int32_t slot) { triangulation_->makeHole(slot); });
}

void Mesh::release(Vertex a, Vertex b) {
    requireAlive(a);
    requireAlive(b);
    const Side side = triangulation_->findEdge(a, b);
    if (side.slot != kNoNumber && !triangulation_->isOutline(side)) {
        triangulation_->release(a, b);
    }
}

bool Mesh::isConstrained(Vertex a, Vertex b) const {
    requireAlive(a);
    requireAlive(b);
    const Side side = triangulation_->findEdge(a, b);
    return side.slot != kNoNumber && triangulation_->isConstrained(side);
}

std::vector<std::pair<Vertex, Vertex>> Mesh::constraints() const {
    std::vector<std::pair<Vertex, Vertex>> constraints;
    for (const Triangle& triangle : triangles().triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            const Vertex a = triangle.corner[next(i)];
            const Vertex b = triangle.corner[previous(i)];
            if (triangle.constrained[i] && triangle.neighbour[i] != kNoNumber && a < b) {
                constraints.emplace_back(a, b);
            }
        }
    }
    std::sort(constraints.begin(), constraints.end());
    return constraints;
}

Mesh::Change Mesh::takeChange() { return triangulation_->changes.takeChange(triangles(), true); }

Mesh::Change Mesh::takeChangeOfTriangles() { return triangulation_->changes.takeChange(triangles(), false); }

Mesh::Difference Mesh::takeDifference() {
    triangulation_->noteDifferences = true;
    return triangulation_->differences.takeDifference(triangles());
}

Mesh Mesh::restore(std::int32_t width, std::int32_t depth, std::span<const std::optional<LatticePoint>> places,
                   std::span<const std::pair<Vertex, Vertex>> constraints, std::shared_ptr<const Holes> holes) {
    Mesh mesh(width, depth, std::move(holes));
    for (std::size_t i = 0; i < 4; ++i) {
        if (i >= places.size() || places[i] != mesh.triangles().places[i]) {
            throw std::invalid_argument("the first four vertices are not the corners of the field");
        }
    }
    std::vector<LatticePoint> there;
    std::vector<Vertex> numbers;
    Triangulation& triangulation = *mesh.triangulation_;
    triangulation.reserveNumbers(places.size());
    for (std::size_t i = 4; i < places.size(); ++i) {
        const auto number = static_cast<Vertex>(i);
        if (!places[i]) {
            triangulation.giveBack(number);
            continue;
        }
        mesh.requireInside(*places[i]);
        there.push_back(*places[i]);
        numbers.push_back(number);
    }
    const auto [order, first] = spatialOrder(there);
    triangulation.reserve(order.size());
    for (std::size_t i = 0; i < there.size(); ++i) {
        if (first[i] != i) {
            throw std::invalid_argument("two vertices at " + toText(there[i]));
        }
    }
    for (const std::uint32_t index : order) {
        if (triangulation.insert(there[index], numbers[index]) < 4) {
            throw std::invalid_argument("a vertex at a corner of the field, " + toText(there[index]));
        }
    }
    for (const auto& [a, b] : constraints) {
        const bool alive = mesh.triangles().alive(a) && mesh.triangles().alive(b) && a != b;
        const Triangulation::Hit hit = alive ? triangulation.follow(a, b) : Triangulation::Hit();
        if (!alive || hit.vertex != b) {
            throw std::invalid_argument("no straight constraint from vertex " + std::to_string(a) + " to " +
                                        std::to_string(b));
        }
        triangulation.carve(a, hit);
    }
    return mesh;
}

}  // namespace sand::tin
