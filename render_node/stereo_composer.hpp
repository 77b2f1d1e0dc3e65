// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "render_node/gl/eye_target.hpp"
#include "render_node/gl/gl_context.hpp"
#include "render_node/gl/gl_program.hpp"
#include "render_node/gl/pixel_rect.hpp"
#include "walls/wall.hpp"

namespace render_node {

/// Composer of a tile's outputs from the pictures of its eyes.
///
/// Mono, left, right, passive and active show the eyes' own targets and take no more memory. Each other mode has one
/// more target, of the size walls::outputPixels() and without depth. Its pixels equal pictures::packStereo() bit for
/// bit. The GL context must be current. Used by one thread.
class StereoComposer {
public:
    /// Throws std::runtime_error if a shader does not compile or if the driver refuses the size of the output.
    StereoComposer(walls::Stereo stereo, const walls::Tile& tile);

    /// Composes the output. Must be called after a pixel of an eye has changed. Does not wait for GL. If the mode shows
    /// the eyes' own targets, it does nothing.
    ///
    /// @param eyes  Pictures in the order of walls::eyesOf(), each of tile.pixels. The output shows them in the order
    /// of
    ///              its own eyes, which is another one if the wall swaps eyes.
    void compose(std::span<const EyeTarget> eyes);
    /// Composes the pixels in `changed`. The eyes must not have changed elsewhere. Returns the pixels of the outputs
    /// that this may have changed.
    PixelRect compose(std::span<const EyeTarget> eyes, const PixelRect& changed);

    /// Returns the pictures of the outputs, in the order of tile.outputs, for GlContext::present(). They point to the
    /// eyes' targets and to this composer's target.
    [[nodiscard]] std::vector<OutputPicture> shown(std::span<const EyeTarget> eyes) const;

    /// Returns the composer's memory in GL [byte].
    [[nodiscard]] std::int64_t bytes() const;

private:
    /// Tables for the anaglyph modes that mix light.
    struct Light {
        explicit Light(walls::Stereo stereo);
        // Entries for two levels per number. The even level is in the lower half.
        std::array<GLuint, 128> lights{};  // linear light of the level
        std::array<GLuint, 128> first{};   // least light that is shown as the level
        glm::mat4 fromLeft{0}, fromRight{0};
    };
    [[nodiscard]] PixelRect copyBeside(std::span<const EyeTarget> eyes, const PixelRect& changed) const;
    void drawMixed(std::span<const EyeTarget> eyes, const PixelRect& changed) const;

    walls::Stereo stereo_;
    /// Indices of the eyes that an output shows. Both are the same if it shows one eye.
    struct Eyes {
        std::size_t first = 0, second = 0;
    };
    std::vector<Eyes> eyesOfOutput_;
    std::optional<EyeTarget> packed_;
    std::optional<GlProgram> program_;
    // Needed because a core profile draws only with a vertex array, even an empty one.
    std::optional<GlVertexArray> array_;
    std::optional<Light> light_;
};

}  // namespace render_node
