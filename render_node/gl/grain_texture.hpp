// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>

#include "render_node/gl/gl_handle.hpp"

namespace render_node {

/// Texture of shapes::grainLevels() in GL.
class GrainTexture {
public:
    explicit GrainTexture(const glm::vec2& sun /* east, north */);
    /// Binds the texture to texture unit `unit`.
    void bind(int unit) const;

private:
    GlTexture texture_;
};

}  // namespace render_node
