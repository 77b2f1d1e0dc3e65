// SPDX-License-Identifier: Apache-2.0
#include "render_node/tin_surface.hpp"

#include <algorithm>
#include <cmath>

#include "render_node/grain_texture.hpp"
#include "render_node/open_sky.hpp"
#include "render_node/tin_star.hpp"
#include "sand/height_field.hpp"

namespace render_node {
namespace {

using sand::tin::kNobody;
using sand::tin::Place;
using sand::tin::SurfaceView;
using sand::tin::Triangles;
using sand::tin::Vertex;

constexpr int kCell = sand::kProbePerCell;
// Height units in a probe unit: normals are computed in these.
constexpr double kUnitsPerProbe = double{sand::kUnitsPerCell} / sand::kProbePerCell;
constexpr double kTrianglesPerChunk = 512;
constexpr double kMostChunksAcross = 64;
// How far a place looks, and the cell beyond that its last look is between [cell].
constexpr int kLightReach = kSkyDistances.back() + 2;

template <class Number>
void sortOnce(std::vector<Number>& numbers) {
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

TinTriangle drawnOf(const sand::tin::Triangle& triangle) {
    TinTriangle drawn;
    if (!triangle.alive()) {
        return drawn;
    }
    const auto least = std::min_element(triangle.corner.begin(), triangle.corner.end()) - triangle.corner.begin();
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t from = (static_cast<std::size_t>(least) + i) % 3;
        drawn.corner[i] = triangle.corner[from];
        drawn.marked[i] = triangle.constrained[from] && triangle.neighbour[from] != kNobody;
    }
    return drawn;
}

/// The mottling of a grid of the same cells, linear between their middles.
std::uint16_t mottlingOf(std::int32_t x, std::int32_t y) {
    const int fromX = std::max(0, x - kCell / 2), fromY = std::max(0, y - kCell / 2);
    const int column = fromX / kCell, row = fromY / kCell, alongX = fromX % kCell, alongY = fromY % kCell;
    const auto between = [&](int at) {
        return mottlingAt(column, at) * (kCell - alongX) + mottlingAt(column + 1, at) * alongX;
    };
    const int sum = between(row) * (kCell - alongY) + between(row + 1) * alongY;  // of kCell² · 255
    return static_cast<std::uint16_t>(static_cast<double>(sum) * 257 / (double{kCell} * kCell));
}

/// The mean normal of the triangles around a vertex by their areas, not of length 1 [unit²].
glm::dvec3 normalAt(const SurfaceView& tin, Vertex vertex) {
    const Triangles& mesh = tin.triangles;
    const auto at = [&](Vertex corner) {
        const Place& place = mesh.places[static_cast<std::size_t>(corner)];
        return glm::dvec3(kUnitsPerProbe * place.x, kUnitsPerProbe * place.y,
                          tin.heights[static_cast<std::size_t>(corner)]);
    };
    struct Pair {
        Vertex first, second;
    };
    std::vector<Pair> around;
    visitStar(mesh, vertex, [&](const StarTriangle& one) {
        const auto& corner = mesh.triangles[static_cast<std::size_t>(one.slot)].corner;
        around.push_back({corner[(one.corner + 1) % 3], corner[(one.corner + 2) % 3]});
    });
    // A sum of floats depends on where it begins: from the smallest neighbour on, around a vertex within the field.
    if (around.front().first == around.back().second) {
        std::ranges::rotate(around, std::ranges::min_element(around, {}, &Pair::first));
    }
    const glm::dvec3 here = at(vertex);
    glm::dvec3 sum(0);
    for (const Pair& pair : around) {
        sum += glm::cross(at(pair.first) - here, at(pair.second) - here);
    }
    return sum;
}

}  // namespace

double TinSurface::chunkSideFor(const Triangles& mesh) {
    const double wanted = std::ceil(std::sqrt(static_cast<double>(mesh.triangles.size()) / kTrianglesPerChunk));
    return std::max(mesh.width, mesh.depth) / std::clamp(wanted, 1.0, kMostChunksAcross);
}

TinSurface::TinSurface(const SurfaceView& tin, double cellSize, double chunkSide)
    : cellSize_(cellSize),
      unit_(cellSize / sand::kUnitsPerCell),
      probe_(cellSize / kCell),
      width_(tin.triangles.width),
      depth_(tin.triangles.depth),
      across_(static_cast<int>(width_ / chunkSide) + 1),
      chunkSide_(chunkSide),
      chunks_(static_cast<std::size_t>(across_) * static_cast<std::size_t>(depth_ / chunkSide + 1)),
      relief_(width_, depth_),
      damaged_(width_ * probe_, depth_ * probe_) {
    const Triangles& mesh = tin.triangles;
    grow(mesh);
    std::vector<Vertex> all;
    for (Vertex number = 0; number < static_cast<Vertex>(mesh.triangleAt.size()); ++number) {
        if (mesh.alive(number)) {
            all.push_back(number);
        }
    }
    ever_.lowest = ever_.highest = static_cast<float>(tin.heights[static_cast<std::size_t>(all.front())] * unit_);
    (void)move(tin, all);
    std::vector<std::int32_t> slots;
    for (std::size_t slot = 0; slot < mesh.triangles.size(); ++slot) {
        replace(static_cast<std::int32_t>(slot), drawnOf(mesh.triangles[slot]));
        addToRelief(tin, triangles_[slot]);
    }
    (void)relief_.takeChanged();
    for (const Vertex number : all) {
        lightFrom(tin, number);
        openTo(tin, number);
    }
}

void TinSurface::grow(const Triangles& mesh) {
    vertices_.resize(std::max(vertices_.size(), mesh.places.size()));
    seen_.resize(vertices_.size());
    triangles_.resize(std::max(triangles_.size(), mesh.triangles.size()));
    inChunk_.resize(triangles_.size());
}

TinSurface::Change TinSurface::update(const SurfaceView& tin, const sand::tin::SurfaceDamage& damage) {
    Change change;
    if (damage.whole) {
        TinSurface anew(tin, cellSize_, chunkSide_);
        anew.ever_ = around(ever_, anew.ever_);
        *this = std::move(anew);
        change.whole = change.rim = true;
        change.boxes.push_back(
            {glm::dvec3(-cellSize_, -cellSize_, ever_.lowest - cellSize_),
             glm::dvec3((width_ + kCell) * probe_, (depth_ + kCell) * probe_, double{ever_.highest} + cellSize_)});
        return change;
    }
    const Triangles& mesh = tin.triangles;
    grow(mesh);
    std::vector<std::int32_t> replaced;
    for (const std::int32_t slot : damage.triangles) {
        if (triangle(slot) != drawnOf(mesh.triangles[static_cast<std::size_t>(slot)])) {
            replaced.push_back(slot);
        }
    }
    std::vector<Vertex> others = moved(tin, damage.vertices);
    std::vector<std::int32_t> reshaped = replaced;
    for (const Vertex number : others) {
        if (mesh.alive(number)) {
            visitStar(mesh, number, [&](const StarTriangle& one) { reshaped.push_back(one.slot); });
        }
    }
    sortOnce(reshaped);
    const auto damageAll = [&] {
        for (const std::int32_t slot : reshaped) {
            if (triangle(slot).alive()) {
                damaged_.add(boxOf(triangle(slot)));
            }
        }
    };
    damageAll();
    change.rim = move(tin, others);
    for (const std::int32_t slot : replaced) {
        replace(slot, drawnOf(mesh.triangles[static_cast<std::size_t>(slot)]));
    }
    damageAll();
    const std::vector<Vertex> lit = relight(tin, reshaped);
    others.insert(others.end(), lit.begin(), lit.end());
    sortOnce(others);
    change.vertices = std::move(others);
    change.boxes = damaged_.take();
    return change;
}

/// The vertices whose light is another since these triangles are; triangles around them are damaged.
std::vector<Vertex> TinSurface::relight(const SurfaceView& tin, const std::vector<std::int32_t>& reshaped) {
    std::vector<Vertex> corners;
    for (const std::int32_t slot : reshaped) {
        if (triangle(slot).alive()) {
            addToRelief(tin, triangle(slot));
            chunks_[static_cast<std::size_t>(inChunk_[static_cast<std::size_t>(slot)].chunk)].reshaped = true;
            corners.insert(corners.end(), triangle(slot).corner.begin(), triangle(slot).corner.end());
        }
    }
    sortOnce(corners);
    std::vector<Vertex> others;
    for (const Vertex number : corners) {
        const bool otherNormal = lightFrom(tin, number);
        const bool otherSky = openTo(tin, number);
        if (otherNormal || otherSky) {
            others.push_back(number);
        }
    }
    for (const Vertex number : verticesAround(relief_.takeChanged())) {
        if (openTo(tin, number)) {
            others.push_back(number);
        }
    }
    for (const Vertex number : others) {
        visitStar(tin.triangles, number, [&](const StarTriangle& one) { damaged_.add(boxOf(triangle(one.slot))); });
    }
    return others;
}

TinVertex TinSurface::placed(const SurfaceView& tin, Vertex number) const {
    TinVertex now = vertices_[static_cast<std::size_t>(number)];
    if (!tin.triangles.alive(number)) {
        now.x = now.y = -1;
        return now;
    }
    const Place& place = tin.triangles.places[static_cast<std::size_t>(number)];
    now.x = place.x;
    now.y = place.y;
    now.height = static_cast<float>(tin.heights[static_cast<std::size_t>(number)] * unit_);
    return now;
}

/// Those of these vertices that came, went or stand elsewhere than drawn.
std::vector<Vertex> TinSurface::moved(const SurfaceView& tin, std::span<const Vertex> asked) const {
    std::vector<Vertex> others;
    for (const Vertex number : asked) {
        if (static_cast<std::size_t>(number) >= vertices_.size()) {
            continue;  // it came and went unseen
        }
        const TinVertex& drawn = vertices_[static_cast<std::size_t>(number)];
        const TinVertex now = placed(tin, number);
        if (drawn.x != now.x || drawn.y != now.y || drawn.height != now.height) {
            others.push_back(number);
        }
    }
    return others;
}

/// Takes over their places and heights; says whether the rim is another.
bool TinSurface::move(const SurfaceView& tin, std::span<const Vertex> vertices) {
    bool rim = false;
    for (const Vertex number : vertices) {
        rim |= keepRim(number, false);
    }
    for (const Vertex number : vertices) {
        TinVertex& drawn = vertex(number);
        drawn = placed(tin, number);
        if (drawn.x >= 0) {
            drawn.mottling = mottlingOf(drawn.x, drawn.y);
            ever_ = around(ever_, {drawn.height, drawn.height});
            rim |= keepRim(number, true);
        }
    }
    return rim;
}

/// Takes a vertex in or out where the rim has it; says whether it does.
bool TinSurface::keepRim(Vertex number, bool present) {
    const TinVertex& drawn = vertex(number);
    if (drawn.x < 0) {
        return false;
    }
    bool onRim = false;
    const auto keep = [&](std::size_t side, bool there, std::int32_t along) {
        if (there && present) {
            rim_[side][along] = number;
        } else if (there) {
            rim_[side].erase(along);
        }
        onRim |= there;
    };
    keep(0, drawn.y == 0, drawn.x);
    keep(1, drawn.x == width_, drawn.y);
    keep(2, drawn.y == depth_, width_ - drawn.x);
    keep(3, drawn.x == 0, depth_ - drawn.y);
    return onRim;
}

SandRim TinSurface::rim() const {
    SandRim rim;
    for (std::size_t side = 0; side < rim_.size(); ++side) {
        for (const auto& [along, number] : rim_[side]) {
            rim.sides[side].emplace_back(at(number));
        }
    }
    return rim;
}

void TinSurface::replace(std::int32_t slot, const TinTriangle& now) {
    if (triangle(slot).alive()) {
        leaveChunk(slot);
    }
    triangle(slot) = now;
    if (!now.alive()) {
        return;
    }
    double x = 0, y = 0;  // [probe unit], three times
    for (const Vertex corner : now.corner) {
        x += vertex(corner).x;
        y += vertex(corner).y;
    }
    InChunk& in = inChunk_[static_cast<std::size_t>(slot)];
    in.chunk = static_cast<int>(y / 3 / chunkSide_) * across_ + static_cast<int>(x / 3 / chunkSide_);
    TinChunk& chunk = chunks_[static_cast<std::size_t>(in.chunk)];
    in.at = static_cast<int>(chunk.slots.size());
    chunk.slots.push_back(slot);
    chunk.changed = chunk.reshaped = true;
}

void TinSurface::leaveChunk(std::int32_t slot) {
    InChunk& in = inChunk_[static_cast<std::size_t>(slot)];
    TinChunk& chunk = chunks_[static_cast<std::size_t>(in.chunk)];
    const std::int32_t last = chunk.slots.back();
    chunk.slots[static_cast<std::size_t>(in.at)] = last;
    inChunk_[static_cast<std::size_t>(last)].at = in.at;
    chunk.slots.pop_back();
    chunk.changed = chunk.reshaped = true;
    in = {};
}

glm::dvec3 TinSurface::at(Vertex number) const {
    const TinVertex& drawn = vertices_[static_cast<std::size_t>(number)];
    return {drawn.x * probe_, drawn.y * probe_, drawn.height};
}

Box TinSurface::boxOf(const TinTriangle& triangle) const {
    const glm::dvec3 a = at(triangle.corner[0]), b = at(triangle.corner[1]), c = at(triangle.corner[2]);
    const double margin = 0.01 * cellSize_;  // for what GL's floats may round
    return {glm::min(a, glm::min(b, c)) - margin, glm::max(a, glm::max(b, c)) + margin};
}

bool TinSurface::settle(TinChunk& chunk) {
    if (!chunk.changed) {
        return false;
    }
    std::ranges::sort(chunk.slots, {}, [this](std::int32_t slot) { return triangle(slot).corner; });
    for (std::size_t i = 0; i < chunk.slots.size(); ++i) {
        inChunk_[static_cast<std::size_t>(chunk.slots[i])].at = static_cast<int>(i);
    }
    chunk.changed = false;
    return true;
}

const Box& TinSurface::boxOf(TinChunk& chunk) const {
    if (chunk.reshaped) {
        chunk.box = boxOf(triangles_[static_cast<std::size_t>(chunk.slots.front())]);
        for (const std::int32_t slot : chunk.slots) {
            chunk.box = around(chunk.box, boxOf(triangles_[static_cast<std::size_t>(slot)]));
        }
        chunk.reshaped = false;
    }
    return chunk.box;
}

void TinSurface::addToRelief(const SurfaceView& tin, const TinTriangle& triangle) {
    if (triangle.alive()) {
        const auto corner = [&](std::size_t i) {
            const auto number = static_cast<std::size_t>(triangle.corner[i]);
            return ReliefCorner{tin.triangles.places[number], tin.heights[number]};
        };
        relief_.put({corner(0), corner(1), corner(2)});
    }
}

bool TinSurface::lightFrom(const SurfaceView& tin, Vertex number) {
    const glm::dvec3 normal = 32767.0 * glm::normalize(normalAt(tin, number));
    const auto east = static_cast<std::int16_t>(normal.x), north = static_cast<std::int16_t>(normal.y);
    TinVertex& drawn = vertex(number);
    const bool other = east != drawn.normalEast || north != drawn.normalNorth;
    drawn.normalEast = east;
    drawn.normalNorth = north;
    return other;
}

bool TinSurface::openTo(const SurfaceView& tin, Vertex number) {
    TinVertex& drawn = vertex(number);
    const auto here = static_cast<float>(tin.heights[static_cast<std::size_t>(number)]);
    float share = 0;
    openSky({&share, 1}, static_cast<float>(sand::kUnitsPerCell), [&](std::size_t, int east, int north) {
        return relief_.at(drawn.x + east * kCell, drawn.y + north * kCell) - here;
    });
    const auto open = static_cast<std::uint16_t>(share * 65535);
    const bool other = open != drawn.open;
    drawn.open = open;
    return other;
}

/// The vertices, each once, that may see these cells of the relief.
std::vector<Vertex> TinSurface::verticesAround(const std::vector<sand::Rect>& cells) {
    std::vector<Vertex> found;
    for (const sand::Rect& rect : cells) {
        const sand::Rect reach = rect.grownBy(kLightReach);
        for (TinChunk& chunk : chunks_) {
            if (chunk.slots.empty()) {
                continue;
            }
            const Box& box = boxOf(chunk);
            if (box.low.x > reach.x1 * cellSize_ || box.high.x < reach.x0 * cellSize_ ||
                box.low.y > reach.y1 * cellSize_ || box.high.y < reach.y0 * cellSize_) {
                continue;
            }
            for (const std::int32_t slot : chunk.slots) {
                for (const Vertex corner : triangle(slot).corner) {
                    const TinVertex& drawn = vertex(corner);
                    if (!seen_[static_cast<std::size_t>(corner)] && drawn.x >= reach.x0 * kCell &&
                        drawn.x <= reach.x1 * kCell && drawn.y >= reach.y0 * kCell && drawn.y <= reach.y1 * kCell) {
                        seen_[static_cast<std::size_t>(corner)] = true;
                        found.push_back(corner);
                    }
                }
            }
        }
    }
    for (const Vertex corner : found) {
        seen_[static_cast<std::size_t>(corner)] = false;
    }
    return found;
}

}  // namespace render_node
