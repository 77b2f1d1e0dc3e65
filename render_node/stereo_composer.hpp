// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "render_node/gl/eye_target.hpp"
#include "render_node/gl/gl_context.hpp"
#include "render_node/gl/gl_program.hpp"
#include "render_node/surface/pixel_rect.hpp"
#include "walls/wall.hpp"

namespace render_node {

/// Makes the pictures of a tile's outputs from what its eyes see.
///
/// Mono, left, right, passive and active show the eyes' own targets and take no memory. The other modes have one more
/// target, of walls::outputPixels and without depth, which equals pictures::packStereo to the bit. Needs its context
/// current; one thread.
class StereoComposer {
public:
    /// Throws std::runtime_error when a shader does not compile or the driver refuses the size of the output.
    StereoComposer(walls::Stereo stereo, const walls::Tile& tile);

    /// Puts the eyes together; needed once whenever a pixel of one has changed. `eyes` are in the order of
    /// walls::eyesOf, each of tile.pixels. Does not wait, and does nothing where the eyes' targets are shown
    /// themselves.
    void compose(std::span<const EyeTarget> eyes);
    /// The same where the eyes have changed within these pixels alone.
    void compose(std::span<const EyeTarget> eyes, const PixelRect& changed);

    /// What each output shows, in the order of tile.outputs, for GlContext::present. Points to the eyes' targets and to
    /// this composer's own.
    [[nodiscard]] std::vector<OutputPicture> shown(std::span<const EyeTarget> eyes) const;

    /// What the composer holds in GL's memory.
    [[nodiscard]] std::int64_t bytes() const;

private:
    /// Tables of the anaglyphs that mix light.
    struct Light {
        explicit Light(walls::Stereo stereo);
        // By level, two to a number, the even level's in the lower half.
        std::array<GLuint, 128> lights{};  // what it emits
        std::array<GLuint, 128> first{};   // the least light that is shown as it
        glm::mat4 fromLeft{0}, fromRight{0};
    };
    void copyBeside(std::span<const EyeTarget> eyes, const PixelRect& changed) const;
    void drawMixed(std::span<const EyeTarget> eyes, const PixelRect& changed) const;

    walls::Stereo stereo_;
    std::vector<std::size_t> eyeOfOutput_;  // index into the eyes, by output
    std::optional<EyeTarget> packed_;
    std::optional<GlProgram> program_;
    std::optional<GlVertexArray> array_;  // core profile: none is drawn without, even an empty one
    std::optional<Light> light_;
};

}  // namespace render_node
