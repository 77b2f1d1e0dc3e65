// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "host/module.hpp"
#include "render_node/gl/gl_context.hpp"
#include "render_node/gl/gl_platform.hpp"

namespace render_node {

/// Loads the backend's module and the libraries of that backend, and returns the platform that the module makes for
/// `request`. Throws base::InputError, with one line, if the module or one of its libraries is missing. Passes on
/// exceptions of the module.
[[nodiscard]] std::unique_ptr<GlPlatform> loadPlatform(
    Backend backend, const PlatformRequest& request,
    const std::vector<std::filesystem::path>& folders = host::moduleFolders());

}  // namespace render_node
