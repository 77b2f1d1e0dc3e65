// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/tool/displacement.hpp"

#include <algorithm>
#include <cstdlib>

namespace sand::tin {
namespace {

constexpr std::int32_t kBands = 32;         // of an outline, for thin()
constexpr std::size_t kMostPresses = 4096;  // of one chunk
// A chunk ends when its box exceeds two reaches by this much [probe unit].
constexpr std::int32_t kWay = 16 * kProbePerCell;

/// Shortest way between two presses [probe unit]. A hand that is sampled often moves less, and every press costs time.
constexpr std::int32_t kNoWay = kProbePerCell / 4;

Offset offsetOf(const LatticePoint& place, const ProbePoint& probe) {
    return {std::int64_t{place.x} - probe.x, std::int64_t{place.y} - probe.y};
}

Box boxOf(const CellRect& cells) {
    return {cells.x0 * kProbePerCell, cells.y0 * kProbePerCell, cells.x1 * kProbePerCell, cells.y1 * kProbePerCell};
}

Box boxOf(const LatticePoint& a, const LatticePoint& b) {
    return {std::min(a.x, b.x), std::min(a.y, b.y), std::max(a.x, b.x), std::max(a.y, b.y)};
}

bool overlaps(const Box& box, const Triangles& field) { return !box.clippedTo(field).empty(); }

/// Calls visit(at, ahead) for each sub-step from one point to the next, without the first point.
template <class Visit>
void forEachSubstep(const ProbePoint& from, const ProbePoint& to, const Visit& visit) {
    const std::int64_t dx = std::int64_t{to.x} - from.x, dy = std::int64_t{to.y} - from.y;
    const std::int64_t dz = std::int64_t{to.z} - from.z;
    const std::int64_t longest = std::max({std::abs(dx), std::abs(dy), std::abs(dz)});
    const std::int64_t steps = substepsBetween(from, to);
    // `ahead` is the direction of the whole way, at most two cells long, as for the tool of a grid.
    const std::int64_t scale = std::max<std::int64_t>(longest / kProbePerCell, 1);
    for (std::int64_t i = 1; i <= steps; ++i) {
        visit(ProbePoint{static_cast<std::int32_t>(from.x + dx * i / steps),
                         static_cast<std::int32_t>(from.y + dy * i / steps),
                         static_cast<std::int32_t>(from.z + dz * i / steps)},
              Offset{dx / scale, dy / scale});
    }
}

}  // namespace

Displacement::Displacement(const Tool& tool, const DetailRules& rules, std::shared_ptr<Neighbourhood> neighbourhood)
    : tool_(tool),
      rules_(rules),
      turned_(tool),
      outline_(Outline::of(tool)),
      neighbourhood_(std::move(neighbourhood)) {}

Underside Displacement::underside(const ProbePoint& probe) const {
    return [shape = turned_, probe](const LatticePoint& place) {
        return shape.underside(probe.z, offsetOf(place, probe));
    };
}

Box Displacement::reach(const ProbePoint& probe) const { return boxOf(turned_.cellsChanged(probe.x, probe.y)); }

Displacement::Work Displacement::drag(VertexSand& layer, Imprint& imprint, Rim rim, std::span<const ProbePoint> path) {
    Work done;
    Chunk chunk;
    const auto add = [&](const Press& press) {
        const Box box = reach(press.probe);
        if (!overlaps(box, layer.triangles())) {
            return;
        }
        const Box joined = chunk.box.joinedWith(box);
        const bool far = joined.x1 - joined.x0 > 2 * (box.x1 - box.x0) + kWay ||
                         joined.y1 - joined.y0 > 2 * (box.y1 - box.y0) + kWay;
        if (!chunk.presses.empty() && (far || chunk.presses.size() == kMostPresses)) {
            work(layer, imprint, rim, chunk, done);
            chunk = {};
        }
        chunk.presses.push_back(press);
        chunk.box = chunk.box.joinedWith(box);
    };
    Press last{path.front(), {0, 0}}, pending = last;
    bool waits = path.size() == 1;
    for (std::size_t i = 1; i < path.size(); ++i) {
        forEachSubstep(path[i - 1], path[i], [&](const ProbePoint& probe, const Offset& ahead) {
            pending = {probe, ahead};
            waits = std::max({std::abs(probe.x - last.probe.x), std::abs(probe.y - last.probe.y),
                              last.probe.z - probe.z}) < kNoWay;
            if (!waits) {
                add(pending);
                last = pending;
            }
        });
    }
    if (waits) {  // the tool always presses at the end of the path
        add(pending);
    }
    if (!chunk.presses.empty()) {
        chunk.last = chunk.presses.back().probe == path.back();
        work(layer, imprint, rim, chunk, done);
    }
    if (imprint.pose && imprint.pose->probe != path.back()) {  // the tool has moved out of the field
        leave(layer, imprint);
    }
    sortOnce(done.touched);
    // A touched vertex may have been removed by a later change of the mesh.
    std::erase_if(done.touched, [&](Vertex vertex) { return !layer.triangles().alive(vertex); });
    return done;
}

void Displacement::leave(VertexSand& layer, Imprint& imprint) {
    if (imprint.pose && !rules_.keepsConstraints) {
        const ProbePoint probe = imprint.pose->probe;
        const Box box = reach(probe);
        if (rules_.spacing > 0) {  // otherwise the neighbourhood is not used
            neighbourhood_->look(layer.triangles(), box);
        }
        changeMesh(layer, imprint, {{{probe, {0, 0}}}, box, false});
    }
    imprint = {};
}

void Displacement::work(VertexSand& layer, Imprint& imprint, Rim rim, const Chunk& chunk, Work& done) {
    neighbourhood_->look(layer.triangles(), chunk.box);
    const Imprint::Pose here{chunk.presses.back().probe, tool_};
    const bool still =
        imprint.pose == here && std::all_of(chunk.presses.begin(), chunk.presses.end(),
                                            [&](const Press& press) { return press.probe == here.probe; });
    if (!still) {
        if (!reachesSand(layer, chunk)) {
            leave(layer, imprint);
            return;
        }
        neighbourhood_->follow(layer.triangles(), changeMesh(layer, imprint, chunk));
    }
    if (isNearHole(layer, chunk.box)) {
        neighbourhood_->look(layer.triangles(), chunk.box);  // after follow() it has no triangles()
    }
    for (const Press& press : chunk.presses) {
        this->press(layer, rim, press, done);
    }
}

bool Displacement::reachesSand(const VertexSand& layer, const Chunk& chunk) const {
    std::int64_t lowest = chunk.presses.front().probe.z;
    for (const Press& press : chunk.presses) {
        lowest = std::min<std::int64_t>(lowest, press.probe.z);
    }
    return isAnyAbove(layer, lowestUnderside(lowest));
}

double Displacement::lowestUnderside(std::int64_t z) const {
    return static_cast<double>((z - tool_.radius) * kUnitsPerProbe);
}

bool Displacement::isAnyAbove(const VertexSand& layer, double height) const {
    const auto isHigher = [&](Vertex vertex) { return layer.heights()[static_cast<std::size_t>(vertex)] > height; };
    return std::any_of(neighbourhood_->triangles().begin(), neighbourhood_->triangles().end(), [&](std::int32_t slot) {
        const Triangle& triangle = layer.triangles().triangles[static_cast<std::size_t>(slot)];
        return !triangle.hole && std::any_of(triangle.corner.begin(), triangle.corner.end(), isHigher);
    });
}

std::vector<Vertex> Displacement::changeMesh(VertexSand& layer, Imprint& imprint, const Chunk& chunk) const {
    const ProbePoint probe = chunk.presses.back().probe;
    const Holes* const holes = isNearHole(layer, chunk.box) ? layer.mesh().holes().get() : nullptr;
    const PlacedOutline outline =
        chunk.last ? placed(outline_, probe.x, probe.y, layer.triangles(), holes) : PlacedOutline{};
    Edges edges;
    if (rules_.spacing > 0) {  // otherwise the edges are not used
        edges = edgesThatStay(layer.triangles(), imprint);
        edges.insert(edges.end(), outline.edges.begin(), outline.edges.end());
    }
    return layer.edit([&](Mesh& mesh) {
        imprint.takeOutOf(mesh);
        thin(mesh, outline);
        std::vector<LatticePoint> there = outline.points;
        for (std::size_t i = 0; rules_.spacing > 0 && i < neighbourhood_->vertices().size(); ++i) {
            const Vertex vertex = neighbourhood_->vertices()[i];
            if (mesh.triangles().alive(vertex)) {
                there.push_back(mesh.triangles().places[index(vertex)]);
            }
        }
        if (chunk.last) {
            imprint.pose = {probe, tool_};
            imprint.putInto(mesh, outline, rules_.maxVertices);
        }
        const auto wanted = [&](const LatticePoint& place) {
            return isNearTool(place, chunk.presses) && (holes == nullptr || !holes->holds(place));
        };
        refine(mesh, rules_, chunk.box, wanted, there, edges);
        if (holes != nullptr) {
            const auto wantedOnBorder = [&](const LatticePoint& place) { return isNearTool(place, chunk.presses); };
            refineHoles(mesh, rules_, chunk.box, wantedOnBorder, there);
        }
        if (chunk.last || !rules_.keepsRim) {  // a rim that keeps its vertices needs none when the tool leaves
            const auto wantedOnRim = [&](const LatticePoint& place) {
                // Holes::holds() returns true for every place that is not inside the field.
                const Triangles& field = mesh.triangles();
                return wanted({std::min(place.x, field.width - 1), std::min(place.y, field.depth - 1)});
            };
            refineRim(mesh, rules_, chunk.box, wantedOnRim, there);
        }
    });
}

/// Returns whether the tool takes or lays down sand at a place or one square farther. All vertices that take sand
/// should have equal and small shares of the ground.
bool Displacement::isNearTool(const LatticePoint& place, const std::vector<Press>& presses) const {
    const std::int64_t step = rules_.spacing;
    for (const Press& press : presses) {
        const Offset offset = offsetOf(place, press.probe);
        for (const auto& [x, y] : {std::pair{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
            const Offset beside{offset.x + x * step, offset.y + y * step};
            if (turned_.takes(beside) || turned_.covers(beside)) {
                return true;
            }
        }
    }
    return false;
}

/// Returns the constraints of earlier imprints.
Edges Displacement::edgesThatStay(const Triangles& mesh, const Imprint& imprint) const {
    std::vector<std::pair<Vertex, Vertex>> ours;
    for (const auto& [a, b] : imprint.edges) {
        ours.emplace_back(std::minmax(a, b));
    }
    std::sort(ours.begin(), ours.end());
    Edges edges;
    for (const std::int32_t slot : neighbourhood_->triangles()) {
        const Triangle& triangle = mesh.triangles[static_cast<std::size_t>(slot)];
        for (std::size_t k = 0; k < 3; ++k) {
            const Vertex a = triangle.corner[(k + 1) % 3], b = triangle.corner[(k + 2) % 3];
            if (a < b && triangle.constrained[k] && triangle.neighbour[k] != kNoNumber &&
                !std::binary_search(ours.begin(), ours.end(), std::pair(a, b))) {
                edges.emplace_back(mesh.places[static_cast<std::size_t>(a)], mesh.places[static_cast<std::size_t>(b)]);
            }
        }
    }
    return edges;
}

/// Removes vertices that would make slivers with the outline.
void Displacement::thin(Mesh& mesh, const PlacedOutline& outline) const {
    const std::int32_t distance = rules_.spacing / 4;
    if (outline.points.empty() || distance == 0) {
        return;
    }
    Box around;
    for (const LatticePoint& place : outline.points) {
        around = around.joinedWith({place.x, place.y, place.x, place.y});
    }
    around = around.grownBy(distance);
    // The outline's edges, and its points as edges without length, by the bands from south to north that they come
    // near.
    const std::int32_t band = std::max((around.y1 - around.y0) / kBands, distance) + 1;
    std::vector<Edges> near(static_cast<std::size_t>((around.y1 - around.y0) / band) + 1);
    const auto put = [&](const LatticePoint& a, const LatticePoint& b) {
        const std::int32_t first = std::min(a.y, b.y) - distance - around.y0;
        const std::int32_t last = std::max(a.y, b.y) + distance - around.y0;
        for (std::int32_t i = first / band; i <= last / band; ++i) {
            near[static_cast<std::size_t>(i)].emplace_back(a, b);
        }
    };
    for (const auto& [a, b] : outline.edges) {
        put(a, b);
    }
    for (const LatticePoint& place : outline.points) {
        put(place, place);
    }
    Link link;
    for (const Vertex vertex : neighbourhood_->vertices()) {
        const LatticePoint place = mesh.triangles().places[static_cast<std::size_t>(vertex)];
        if (!mesh.triangles().alive(vertex) || !around.holds(place)) {
            continue;
        }
        const Edges& here = near[static_cast<std::size_t>((place.y - around.y0) / band)];
        if (std::any_of(here.begin(), here.end(), [&](const auto& edge) {
                return boxOf(edge.first, edge.second).grownBy(distance).holds(place) &&
                       isNear(place, edge.first, edge.second, distance);
            })) {
            findLink(mesh.triangles(), vertex, link);
            if (!link.constrained && (link.closed || !rules_.keepsRim)) {
                mesh.remove(vertex);
            }
        }
    }
}

}  // namespace sand::tin
