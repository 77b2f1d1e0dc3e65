// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "host/module.hpp"
#include "render_node/gl/gl_context.hpp"
#include "render_node/gl/gl_platform.hpp"

namespace render_node {

/// Loads the backend's module, and with it the libraries of that backend alone, and has it do what is asked. Throws
/// base::InputError in one line when the module or one of its libraries is missing, or what the module throws.
[[nodiscard]] std::unique_ptr<GlPlatform> loadPlatform(
    Backend backend, const PlatformRequest& request,
    const std::vector<std::filesystem::path>& folders = host::moduleFolders());

}  // namespace render_node
