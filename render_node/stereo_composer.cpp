// SPDX-License-Identifier: Apache-2.0
#include "render_node/stereo_composer.hpp"

#include <algorithm>

#include "pictures/anaglyph.hpp"

namespace render_node {
namespace {

using walls::Stereo;

bool isBeside(Stereo stereo) { return stereo == Stereo::sideBySide || stereo == Stereo::topBottom; }
bool mixesLight(Stereo stereo) { return stereo == Stereo::anaglyphHalf || stereo == Stereo::anaglyphDubois; }

glm::mat4 toMatrix(const std::array<std::array<std::int32_t, 3>, 3>& weights) {
    glm::mat4 matrix(0);
    for (std::size_t to = 0; to < 3; ++to) {
        for (std::size_t from = 0; from < 3; ++from) {
            matrix[static_cast<int>(to)][static_cast<int>(from)] = static_cast<float>(weights[to][from]);
        }
    }
    return matrix;
}

void bindTexture(GLenum unit, GLuint texture) {
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(GL_TEXTURE_2D, texture);
}

/// Returns the index of an eye in walls::eyesOf(stereo). Returns 0 if the mode does not draw it, as when a mode of
/// one eye is shown on the outputs of two.
std::size_t eyeIndex(Stereo stereo, walls::Eye eye) {
    const auto eyes = walls::eyesOf(stereo);
    const auto found = std::find(eyes.begin(), eyes.end(), eye);
    return found == eyes.end() ? 0 : static_cast<std::size_t>(found - eyes.begin());
}

}  // namespace

StereoComposer::Light::Light(Stereo stereo)
    : fromLeft(toMatrix(pictures::anaglyphWeights(stereo).left)),
      fromRight(toMatrix(pictures::anaglyphWeights(stereo).right)) {
    const std::vector<std::uint8_t>& levels = pictures::levelOfLight();
    for (std::size_t level = 0; level < 256; ++level) {
        const auto least = std::lower_bound(levels.begin(), levels.end(), level) - levels.begin();
        const unsigned half = level % 2 == 0 ? 0 : 16;
        lights[level / 2] |= GLuint{pictures::lightOfLevel()[level]} << half;
        first[level / 2] |= static_cast<GLuint>(least) << half;
    }
}

StereoComposer::StereoComposer(Stereo stereo, const walls::Tile& tile) : stereo_(stereo) {
    for (const walls::Output& output : tile.outputs) {
        eyesOfOutput_.push_back({eyeIndex(stereo, output.eyes.at(0)), eyeIndex(stereo, output.eyes.back())});
    }
    if (!walls::packsEyes(stereo)) {
        return;
    }
    const glm::ivec2 size = walls::outputPixels(stereo, tile.pixels);
    packed_.emplace(size.x, size.y, EyeTarget::Depth::none);
    if (isBeside(stereo)) {
        return;
    }
    if (mixesLight(stereo)) {
        light_.emplace(stereo);
    }
    const ShaderSource nothing;  // needs no light of the scene
    program_.emplace(shaderSource("whole.vert.glsl"), nothing,
                     shaderSource(light_ ? "anaglyph.frag.glsl" : "pack.frag.glsl"));
    array_.emplace();
}

void StereoComposer::compose(std::span<const EyeTarget> eyes) {
    (void)compose(eyes, allPixels({eyes[0].width(), eyes[0].height()}));
}

PixelRect StereoComposer::compose(std::span<const EyeTarget> eyes, const PixelRect& changed) {
    if (!packed_ || changed.empty()) {
        return changed;
    }
    if (isBeside(stereo_)) {
        return copyBeside(eyes, changed);
    }
    drawMixed(eyes, changed);
    return changed;
}

PixelRect StereoComposer::copyBeside(std::span<const EyeTarget> eyes, const PixelRect& changed) const {
    const bool beside = stereo_ == Stereo::sideBySide;
    glDisable(GL_SCISSOR_TEST);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, packed_->framebuffer());
    const auto copy = [&](const EyeTarget& eye, int x, int y) {
        const auto& [x0, y0, x1, y1] = changed;
        glBindFramebuffer(GL_READ_FRAMEBUFFER, eye.framebuffer());
        const PixelRect to{x + x0, y + y0, x + x1, y + y1};
        glBlitFramebuffer(x0, y0, x1, y1, to.x0, to.y0, to.x1, to.y1, GL_COLOR_BUFFER_BIT, GL_NEAREST);
        return to;
    };
    const auto& [first, second] = eyesOfOutput_.front();
    const PixelRect before = copy(eyes[first], 0, beside ? 0 : eyes[0].height());  // GL counts rows from the bottom
    const PixelRect behind = copy(eyes[second], beside ? eyes[0].width() : 0, 0);
    return around(before, behind);
}

void StereoComposer::drawMixed(std::span<const EyeTarget> eyes, const PixelRect& changed) const {
    packed_->bind();
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    program_->use();
    program_->set("uLeft", 0);
    program_->set("uRight", 1);
    const auto& [first, second] = eyesOfOutput_.front();
    bindTexture(1, eyes[second].colour());
    if (light_) {
        program_->set("uLights", light_->lights);
        program_->set("uFirst", light_->first);
        program_->set("uFromLeft", light_->fromLeft);
        program_->set("uFromRight", light_->fromRight);
    } else {
        program_->set("uHeight", packed_->height());
        program_->set("uOddColumns", stereo_ == Stereo::checkerboard ? 1 : 0);
        program_->set("uChannels", stereo_ == Stereo::anaglyphColour ? 1 : 0);
    }
    bindTexture(0, eyes[first].colour());  // last, because unit 0 must stay active
    glBindVertexArray(array_->id());
    glEnable(GL_SCISSOR_TEST);
    glScissor(changed.x0, changed.y0, changed.x1 - changed.x0, changed.y1 - changed.y0);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    program_->drawn();
    glDisable(GL_SCISSOR_TEST);
}

std::vector<OutputPicture> StereoComposer::shown(std::span<const EyeTarget> eyes) const {
    std::vector<OutputPicture> pictures;
    for (const auto& [first, second] : eyesOfOutput_) {
        if (packed_) {
            pictures.push_back({&*packed_, nullptr});
        } else if (stereo_ == Stereo::active) {
            pictures.push_back({&eyes[first], &eyes[second]});
        } else {
            pictures.push_back({&eyes[first], nullptr});
        }
    }
    return pictures;
}

std::int64_t StereoComposer::bytes() const { return packed_ ? packed_->bytes() : 0; }

}  // namespace render_node
