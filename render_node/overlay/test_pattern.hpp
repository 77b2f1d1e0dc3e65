// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "lockstep/test_pattern.hpp"
#include "render_node/gl/eye_target.hpp"
#include "render_node/overlay/flat_painter.hpp"
#include "walls/wall.hpp"

namespace render_node {

/// Painter of the test patterns for adjusting a wall (docs/test_patterns.md). A pattern replaces the picture of the
/// sand.
///
/// The object is made when a pattern is first shown. Patterns lie in the plane of the screen and do not depend on the
/// eyes' positions. The GL context must be current. Used by one thread.
class TestPatternView {
public:
    /// Patterns show `host` unchanged. Throws std::runtime_error if a shader does not compile.
    TestPatternView(const walls::Wall& wall, const walls::Tile& tile, std::string host);

    /// Fills the colours of `target` and leaves its depth unchanged. Throws std::invalid_argument for Pattern::none.
    void draw(lockstep::Pattern pattern, walls::Eye eye, std::uint64_t frame, const EyeTarget& target);

private:
    void drawGrid(const EyeTarget& target);
    void addTile(walls::Eye eye, glm::ivec2 size);
    void addEyes(walls::Eye eye, glm::ivec2 size);
    void addFlash(std::uint64_t frame, glm::ivec2 size);
    void addRamp(glm::ivec2 size);
    void addCentred(std::string_view text, glm::ivec2 topLeft, glm::ivec2 box, glm::vec3 colour);

    walls::Tile tile_;
    std::string host_;
    glm::dvec2 corner_;  // lower left corner of the tile, from the middle of the wall or of the screen [m]
    double spacing_;     // of the grid [m]
    FlatPainter painter_;
    GlProgram gridProgram_;
    GlVertexArray noVertices_;
};

/// Returns the spacing of the cross grid on a wall or screen of this size [m]. It is 1, 2 or 5 times a power of ten:
/// the largest one that is at most an eighth of the shorter side.
[[nodiscard]] double gridSpacing(glm::dvec2 size /* [m] */);

}  // namespace render_node
