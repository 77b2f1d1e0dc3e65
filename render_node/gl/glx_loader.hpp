// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace render_node {

/// Source of GLX's extensions. Tests simulate it. Drawables and displays are opaque here.
struct GlxLoader {
    std::function<bool(const char* extension)> supports;
    std::function<void (*(const char* function))()> functionNamed;
    void* display = nullptr;
    int screen = 0;
    /// Returns a function of an extension. The dispatch library returns an address for any name, so only the extension
    /// list says whether the function can be called.
    template <class Function>
    [[nodiscard]] Function load(const char* name) const {
        return reinterpret_cast<Function>(functionNamed(name));
    }
};
using GlxDrawable = unsigned long;

}  // namespace render_node
