// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <string>

#include "render_node/gl/gl_context.hpp"

namespace render_node {

/// Returns the environment variable with which Mesa would end this process or refuse OpenGL 3.3, and what to do; an
/// empty text if there is none.
///
/// The answer is certain for OSMesa, which is always Mesa. The driver of another backend may ignore the variables, so
/// this function accepts them, and environmentHint() names them once a context was refused.
[[nodiscard]] std::string environmentFault(Backend backend);

/// Returns the end of a sentence that names the variables that change what Mesa offers; an empty text if none is set.
[[nodiscard]] std::string environmentHint();

}  // namespace render_node
