// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "render_node/gl/gl_context.hpp"
#include "render_node/gl/gl_platform.hpp"

namespace render_node {

/// Back buffer of a window that a picture is copied to.
enum class BackBuffer : std::uint8_t { only, left, right };

/// Copy of one picture to a back buffer of a window.
struct Copy {
    const EyeTarget* picture = nullptr;
    BackBuffer to = BackBuffer::only;
    friend bool operator==(const Copy&, const Copy&) = default;
};

/// Returns the copies to make for `output` in frame `frame`.
///
/// With quad buffers both eyes are copied at once. Without quad buffers, even frames of the wall show the left eye and
/// odd frames the right one. So all tiles show the same eye, even if some have missed frames.
[[nodiscard]] std::vector<Copy> copiesOf(const OutputPicture& output, bool quadBuffers, std::uint64_t frame);

/// Returns the request for the backend of `tile`. It has windows if `backend` shows windows; their titles have
/// `sceneName`. With eyes in turn it has the wall's refresh rate for its monitors.
[[nodiscard]] PlatformRequest platformRequest(Backend backend, const walls::Wall& wall, const walls::Tile& tile,
                                              const std::string& sceneName = {});

/// Returns a context that shows its pictures in the platform's windows, one for each of `windows`.
[[nodiscard]] std::unique_ptr<GlContext> makeWindowContext(Backend backend, std::unique_ptr<GlPlatform> platform,
                                                           const std::vector<WindowRequest>& windows);

}  // namespace render_node
