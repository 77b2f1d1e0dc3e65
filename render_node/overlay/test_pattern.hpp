// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "lockstep/test_pattern.hpp"
#include "render_node/gl/eye_target.hpp"
#include "render_node/overlay/flat_painter.hpp"
#include "walls/wall.hpp"

namespace render_node {

/// Draws what a person adjusts a wall by (docs/test_patterns.md) in place of the sand.
///
/// Made when a pattern is first asked for: a wall that shows sand holds none of it. Patterns lie in the plane of the
/// screen and do not depend on where the eyes are. Needs its context current; one thread.
class TestPatternView {
public:
    /// `host` is shown as it is. Throws std::runtime_error when a shader does not compile.
    TestPatternView(const walls::Wall& wall, const walls::Tile& tile, std::string host);

    /// Fills the target, whose depth is left alone. Throws std::invalid_argument for Pattern::none.
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
    glm::dvec2 corner_;  // of the tile, from the middle of the wall or of the screen [m]
    double spacing_;     // [m]
    FlatPainter painter_;
    GlProgram gridProgram_;
    GlVertexArray noVertices_;
};

/// Spacing of the cross grid on a wall or screen: 1, 2 or 5 times a power of ten, about an eighth of the shorter side
/// or less [m].
[[nodiscard]] double gridSpacing(glm::dvec2 size /* [m] */);

}  // namespace render_node
