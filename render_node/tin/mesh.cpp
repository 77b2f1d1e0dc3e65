// SPDX-License-Identifier: Apache-2.0
#include "render_node/tin/mesh.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include "render_node/gl/vertex_attribute.hpp"

namespace render_node {
namespace {

using sand::TinChange;
using sand::tin::SurfaceView;
using sand::tin::Vertex;

using Indices = std::array<std::uint32_t, 3>;

constexpr std::int32_t kGap = 8;  // sending up to this many unchanged entries is cheaper than another GL call

/// Calls send(first, end) for each run of ascending numbers.
template <class Send>
void forEachRun(std::span<const std::int32_t> numbers, const Send& send) {
    for (std::size_t i = 0; i < numbers.size();) {
        std::size_t last = i;
        while (last + 1 < numbers.size() && numbers[last + 1] <= numbers[last] + kGap) {
            ++last;
        }
        send(static_cast<std::size_t>(numbers[i]), static_cast<std::size_t>(numbers[last]) + 1);
        i = last + 1;
    }
}

/// Calls draw(first, end) for the triangles of all parts for which wanted(part) is true. Consecutive parts share one
/// call.
template <class Wanted, class Draw>
void forEachRunOf(const std::vector<TinChunk::Part>& parts, const Wanted& wanted, const Draw& draw) {
    std::size_t first = 0, end = 0;  // run of wanted triangles that is not drawn yet
    const auto drawSome = [&] {
        if (first < end) {
            draw(first, end);
        }
    };
    for (const TinChunk::Part& part : parts) {
        if (wanted(part)) {
            if (part.first != end) {
                drawSome();
                first = part.first;
            }
            end = part.end;
        }
    }
    drawSome();
}

void describeTinVertex() {
    constexpr auto attribute = describeAttribute<shapes::TinVertex>;
    attribute(0, 1, GL_FLOAT, GL_FALSE, offsetof(shapes::TinVertex, height));
    attribute(1, 2, GL_INT, GL_FALSE, offsetof(shapes::TinVertex, x));
    attribute(2, 2, GL_SHORT, GL_TRUE, offsetof(shapes::TinVertex, normalEast));
    attribute(3, 2, GL_UNSIGNED_SHORT, GL_TRUE, offsetof(shapes::TinVertex, open));
}

/// Returns the corners of a triangle, starting with corner `first`.
Indices indicesOf(const shapes::TinTriangle& triangle, std::size_t first) {
    const auto corner = [&](std::size_t i) { return static_cast<std::uint32_t>(triangle.corner[(first + i) % 3]); };
    return {corner(0), corner(1), corner(2)};
}

}  // namespace

TinMesh::TinMesh(const SurfaceView& tin, double cellSize)
    : surface_(tin, cellSize),
      probe_(static_cast<float>(sand::probeUnit(cellSize))),
      field_(tin.triangles.width, tin.triangles.depth),
      buffers_(surface_.chunks().size()) {
    glBindVertexArray(array_.id());
    glBindBuffer(GL_ARRAY_BUFFER, vertices_.id());
    describeTinVertex();
    sendAllVertices();
}

bool TinMesh::update(const sand::SurfaceData& data, const sand::SurfaceChange& change,
                     std::span<const glm::dmat4> cameras) {
    const SurfaceView& tin = std::get<sand::TinData>(data).view;
    if (change.whole) {
        backlog_.clear();
        placesRead_ += static_cast<std::int64_t>(tin.triangles.triangles.size() + tin.heights.size());
        return takeOver(surface_.replaceWhole(tin));
    }
    const auto& parts = std::get<TinChange>(change.parts);
    bool rimToo = false;  // a change of the rim also changes the box around the sand, which is visible from everywhere
    if (!parts.triangles.empty() || !parts.vertices.empty()) {
        const std::optional<shapes::Box> reach = surface_.reachOf(tin, parts);
        rimToo = !reach;
        backlog_.add(parts, reach.value_or(shapes::Box{}));
    }
    if (!rimToo && !backlog_.isSeen(cameras)) {
        return false;
    }
    const TinChange all = backlog_.take();
    placesRead_ += static_cast<std::int64_t>(all.triangles.size() + all.vertices.size());
    return takeOver(surface_.update(tin, all));
}

bool TinMesh::takeOver(const TinVertices::Change& change) {
    if (change.boxes.empty() && change.vertices.empty()) {
        return false;
    }
    ++revision_;
    for (const shapes::Box& box : change.boxes) {
        changes_.add(revision_, box);
    }
    if (change.whole) {
        buffers_.clear();
        buffers_.resize(surface_.chunks().size());
        bytes_ = room_ * sizeof(shapes::TinVertex);
    }
    if (change.whole || surface_.vertices().size() > room_) {
        sendAllVertices();
    } else {
        sendVertices(change.vertices);
    }
    return change.rim;
}

void TinMesh::sendAllVertices() {
    const std::vector<shapes::TinVertex>& all = surface_.vertices();
    bytes_ -= room_ * sizeof(shapes::TinVertex);
    // Leaves room, so that a growing surface is not sent whole each time.
    room_ = std::max(room_, all.size() + all.size() / 4);
    bytes_ += room_ * sizeof(shapes::TinVertex);
    glBindBuffer(GL_ARRAY_BUFFER, vertices_.id());
    glBufferData(GL_ARRAY_BUFFER, bytesOf<shapes::TinVertex>(room_), nullptr, GL_DYNAMIC_DRAW);
    glBufferSubData(GL_ARRAY_BUFFER, 0, bytesOf<shapes::TinVertex>(all.size()), all.data());
}

void TinMesh::sendVertices(std::span<const Vertex> changed) {
    glBindBuffer(GL_ARRAY_BUFFER, vertices_.id());
    forEachRun(changed, [this](std::size_t first, std::size_t end) {
        glBufferSubData(GL_ARRAY_BUFFER, bytesOf<shapes::TinVertex>(first), bytesOf<shapes::TinVertex>(end - first),
                        &surface_.vertices()[first]);
    });
}

void TinMesh::prepare(const GlProgram& program) const {
    program.set("uCell", probe_);
    program.set("uCells", field_);
    program.set("uFirst", 0.0F);
}

template <class Visit>
void TinMesh::visitSeen(const glm::dmat4& sceneToClip, bool culling, const Visit& visit) {
    for (std::size_t i = 0; i < buffers_.size(); ++i) {
        TinChunk& chunk = surface_.chunks()[i];
        if (!chunk.slots.empty() && (!culling || shapes::inFrustum(surface_.boxOf(chunk), sceneToClip))) {
            visit(i);
        }
    }
}

DrawnSurface::Drawn TinMesh::draw(const glm::dmat4& sceneToClip, bool culling, const LevelRule&,
                                  const ProgramChoice& choose) {
    Drawn drawn;
    glBindVertexArray(array_.id());
    visitSeen(sceneToClip, culling, [&](std::size_t i) {
        TinChunk& chunk = surface_.chunks()[i];
        sendTriangles(i);
        if (choose) {
            choose(surface_.boxOf(chunk)).use();
        }
        ++drawn.chunks;
        const auto seen = [&](const TinChunk::Part& part) {
            return !culling || shapes::inFrustum(part.box, sceneToClip);
        };
        forEachRunOf(surface_.partsOf(chunk), seen, [&](std::size_t first, std::size_t end) {
            const auto count = static_cast<int>(end - first);
            glDrawElements(GL_TRIANGLES, 3 * count, GL_UNSIGNED_INT,
                           reinterpret_cast<const void*>(first * sizeof(Indices)));
            drawn.triangles += count;
            pace_.drawn(count);
        });
    });
    return drawn;
}

/// Binds the element buffer of a chunk, and sends the chunk's triangles if GL does not have them.
void TinMesh::sendTriangles(std::size_t i) {
    TinChunk& chunk = surface_.chunks()[i];
    Buffers& buffers = buffers_[i];
    if (!buffers.triangles) {
        buffers.triangles.emplace();
    }
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers.triangles->id());
    if (!surface_.settle(chunk)) {
        return;
    }
    std::vector<Indices> all;
    for (const std::int32_t slot : chunk.slots) {
        all.push_back(indicesOf(surface_.triangles()[static_cast<std::size_t>(slot)], 0));
    }
    bytes_ += (all.size() - buffers.sent) * sizeof(Indices);
    buffers.sent = all.size();
    buffers.marksStale = true;
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, bytesOf<Indices>(all.size()), all.data(), GL_DYNAMIC_DRAW);
}

void TinMesh::drawMarks(const glm::dmat4& sceneToClip, bool culling,
                        const std::function<void(const GlProgram&)>& prepare) {
    if (!markProgram_) {
        markProgram_.emplace(ProgramFiles{"sand.vert.glsl", "mark.frag.glsl", "sunlit.glsl", "mark.geom.glsl"});
    }
    prepare(*markProgram_);
    glPolygonOffset(-2, -4);  // in front of the wires, also for triangles that begin at another corner
    glBindVertexArray(array_.id());
    visitSeen(sceneToClip, culling, [&](std::size_t i) {
        sendMarks(i);
        if (buffers_[i].marked > 0) {
            glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers_[i].marks->id());
            glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * buffers_[i].marked), GL_UNSIGNED_INT, nullptr);
        }
    });
}

/// Sends the marked edges of a chunk: for each one the triangle beside it, starting with the corner opposite the edge.
void TinMesh::sendMarks(std::size_t i) {
    Buffers& buffers = buffers_[i];
    if (!buffers.marksStale) {
        return;
    }
    std::vector<Indices> marks;
    for (const std::int32_t slot : surface_.chunks()[i].slots) {
        const shapes::TinTriangle& triangle = surface_.triangles()[static_cast<std::size_t>(slot)];
        for (std::size_t edge = 0; edge < 3; ++edge) {
            if (triangle.marked[edge]) {
                marks.push_back(indicesOf(triangle, edge));
            }
        }
    }
    bytes_ += (marks.size() - buffers.marked) * sizeof(Indices);
    buffers.marked = marks.size();
    buffers.marksStale = false;
    if (!marks.empty()) {
        if (!buffers.marks) {
            buffers.marks.emplace();
        }
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers.marks->id());
        glBufferData(GL_ELEMENT_ARRAY_BUFFER, bytesOf<Indices>(marks.size()), marks.data(), GL_DYNAMIC_DRAW);
    }
}

std::vector<shapes::Box> TinMesh::changesSince(std::uint64_t revision, DrawnLevels&, const LevelRule&) {
    std::vector<shapes::Box> boxes;
    for (const auto& part : changes_.since(revision)) {
        boxes.push_back(part.where);
    }
    return boxes;
}

}  // namespace render_node
