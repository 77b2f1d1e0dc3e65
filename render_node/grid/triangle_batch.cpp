// SPDX-License-Identifier: Apache-2.0
#include "render_node/grid/triangle_batch.hpp"

#include <cstdint>

namespace render_node {
void TriangleBatch::add(const VertexPages::Range& vertices, const GlProgram* program, int first, int count) {
    if (program != program_ || triangles_ >= TrianglePace::kTrianglesPerFlush ||
        (vertices_ != nullptr && !vertices_->sharesPageWith(vertices))) {
        draw();
    }
    if (program != program_) {
        program->use();
    }
    program_ = program;
    vertices_ = &vertices;
    counts_.push_back(count);
    places_.push_back(reinterpret_cast<const void*>(static_cast<std::size_t>(first) * sizeof(std::uint16_t)));
    bases_.push_back(vertices.first());
    triangles_ += count / 3;
}

void TriangleBatch::draw() {
    if (counts_.empty()) {
        return;
    }
    vertices_->bind(indices_);
    glMultiDrawElementsBaseVertex(GL_TRIANGLES, counts_.data(), GL_UNSIGNED_SHORT, places_.data(),
                                  static_cast<GLsizei>(counts_.size()), bases_.data());
    pace_->drawn(triangles_);
    counts_.clear();
    places_.clear();
    bases_.clear();
    triangles_ = 0;
}

}  // namespace render_node
