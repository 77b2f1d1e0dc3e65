// SPDX-License-Identifier: Apache-2.0
#include "render_node/gl/gl_module.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <string>
#include <system_error>

#include "files/input_error.hpp"

namespace render_node {
namespace {

namespace fs = std::filesystem;

/// Debian's packages with the library a module is linked to, and with its headers.
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

void* open(const fs::path& module, Backend backend) {
    // Never closed: drivers leave threads and thread-local memory behind that outlive any context.
    void* handle = dlopen(module.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (handle == nullptr) {
        const char* reason = dlerror();
        throw files::InputError("--gl " + std::string(backendName(backend)) + ": " +
                                (reason == nullptr ? module.string() + " cannot be loaded" : reason) +
                                "; install Debian's " + packagesOf(backend).library + ", or choose another --gl");
    }
    return handle;
}

}  // namespace

std::vector<fs::path> moduleFolders() {
    std::error_code none;
    const fs::path bin = fs::read_symlink("/proc/self/exe", none).parent_path();
    return {bin, bin.parent_path() / "lib" / "sandwall"};
}

std::unique_ptr<GlPlatform> loadPlatform(Backend backend, const PlatformRequest& request,
                                         const std::vector<fs::path>& folders) {
    const std::string file = "sandwall-gl-" + std::string(backendName(backend)) + ".so";
    const auto folder = std::find_if(folders.begin(), folders.end(), [&](const fs::path& candidate) {
        std::error_code none;
        return fs::exists(candidate / file, none);
    });
    if (folder == folders.end()) {
        std::string places;
        for (const fs::path& candidate : folders) {
            places += (places.empty() ? "" : " and ") + candidate.string();
        }
        throw files::InputError("--gl " + std::string(backendName(backend)) + ": there is no " + file + " in " +
                                places + "; build Sandwall with Debian's " + packagesOf(backend).headers);
    }
    void* symbol = dlsym(open(*folder / file, backend), kGlPlatformSymbol);
    if (symbol == nullptr) {
        throw files::InputError((*folder / file).string() +
                                " belongs to another version of Sandwall; build programs and modules together");
    }
    return std::unique_ptr<GlPlatform>(reinterpret_cast<decltype(&sandwallGlPlatform1)>(symbol)(request));
}

}  // namespace render_node
