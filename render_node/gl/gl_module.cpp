// SPDX-License-Identifier: Apache-2.0
#include "render_node/gl/gl_module.hpp"

#include <string>

namespace render_node {
namespace {

namespace fs = std::filesystem;

/// Debian's packages for a backend's module: the library that the module links, and the headers.
struct Packages {
    const char* library;
    const char* headers;
};
Packages packagesOf(Backend backend) {
    switch (backend) {
        case Backend::egl:
            return {"libegl1", "libegl-dev"};
        case Backend::glfw:
            return {"libglfw3", "libglfw3-dev"};
        default:
            return {"libosmesa6", "libosmesa6-dev"};
    }
}

}  // namespace

std::unique_ptr<GlPlatform> loadPlatform(Backend backend, const PlatformRequest& request,
                                         const std::vector<fs::path>& folders) {
    const std::string name(base::nameOf(backend));
    const Packages packages = packagesOf(backend);
    void* const symbol = host::loadModule(
        {.file = "sandwall-gl-" + name + ".so",
         .symbol = kGlPlatformSymbol,
         .askedBy = "--gl " + name,
         .ifMissing = "build Sandwall with Debian's " + std::string(packages.headers),
         .ifNotLoaded = "install Debian's " + std::string(packages.library) + ", or choose another --gl"},
        folders);
    return std::unique_ptr<GlPlatform>(reinterpret_cast<decltype(&sandwallGlPlatform8)>(symbol)(request));
}

}  // namespace render_node
