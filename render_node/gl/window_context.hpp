// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "render_node/gl/gl_context.hpp"
#include "render_node/gl/gl_platform.hpp"

namespace render_node {

/// The back buffers of a window that pictures go to.
enum class BackBuffer : std::uint8_t { only, left, right };

/// One picture on its way to a window.
struct Copy {
    const EyeTarget* picture = nullptr;
    BackBuffer to = BackBuffer::only;
    friend bool operator==(const Copy&, const Copy&) = default;
};

/// What goes where in a frame: both eyes at once into quad buffers; without them the left one in even frames of the
/// wall and the right one in odd frames, so that all tiles show the same eye whatever each has missed.
[[nodiscard]] std::vector<Copy> copiesOf(const OutputPicture& output, bool quadBuffers, std::uint64_t frame);

/// Returns what a tile of the wall asks its backend for: windows where `backend` shows some, and with eyes in turn the
/// wall's refresh rate for its monitors.
[[nodiscard]] PlatformRequest platformRequest(Backend backend, const walls::Wall& wall, const walls::Tile& tile);

/// Loads OpenGL's functions through the platform, whose context 0 must be current. Throws base::InputError.
void loadFunctions(GlPlatform& platform);

/// A context that shows its pictures in the windows of the platform, one for each of `windows`.
[[nodiscard]] std::unique_ptr<GlContext> makeWindowContext(std::unique_ptr<GlPlatform> platform,
                                                           const std::vector<WindowRequest>& windows);

}  // namespace render_node
