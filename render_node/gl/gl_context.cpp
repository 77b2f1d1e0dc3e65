// SPDX-License-Identifier: Apache-2.0
#include "render_node/gl/gl_context.hpp"

#include <glad/gl.h>

#include <algorithm>
#include <array>
#include <bit>

#include "base/not_yet_error.hpp"
#include "render_node/gl/compiler_memory.hpp"
#include "render_node/gl/gl_environment.hpp"
#include "render_node/gl/gl_module.hpp"
#include "render_node/gl/window_context.hpp"
#include "walls/window_size.hpp"

namespace render_node {
namespace {

std::unique_ptr<GlContext> contextOf(Backend backend, const PlatformRequest& request) {
    if (const std::string fault = environmentFault(backend); !fault.empty()) {
        throw base::InputError(fault);
    }
    std::unique_ptr<GlContext> context;
    try {
        std::unique_ptr<GlPlatform> platform = loadPlatform(backend, request);
        if (request.windows.empty()) {
            context = std::make_unique<GlContext>(backend, std::move(platform));
        } else {
            context = makeWindowContext(backend, std::move(platform), request.windows);
        }
    } catch (const base::NotYetError&) {
        throw;  // a display or monitor is missing, which no variable of Mesa changes
    } catch (const base::InputError& error) {
        throw base::InputError(error.what() + environmentHint());
    }
    giveBackCompilerMemory();  // memory from starting the driver
    return context;
}

/// Returns whether `automatic` has chosen EGL to draw in memory, and the wall file names no device.
bool isSoftware(Backend backend, const walls::Tile& tile) {
    return backend == Backend::automatic && backendFor(backend, tile) == Backend::egl && tile.place.device < 0;
}

/// Returns the title of an output's window, such as "Sandwall – dunes". If the wall has several windows, it names the
/// tile, and if the tile has several, the eye.
std::string titleOf(const std::string& sceneName, const walls::Wall& wall, const walls::Tile& tile,
                    const walls::Output& output) {
    std::string title = "Sandwall" + (sceneName.empty() ? "" : " – " + sceneName);
    if (wall.tiles.size() > 1) {
        title += ", tile " + tile.name;
    }
    if (tile.outputs.size() > 1) {
        title += ", " + std::string(walls::eyeName(output.eyes.front())) + " eye";
    }
    return title;
}

}  // namespace

const Backend kInMemory = SANDWALL_OSMESA != 0 ? Backend::osmesa : Backend::egl;

Backend backendFor(Backend backend, const walls::Tile& tile) {
    if (backend != Backend::automatic) {
        return backend;
    }
    const bool shown = !tile.place.display.empty() ||
                       std::any_of(tile.outputs.begin(), tile.outputs.end(), [](const walls::Output& output) {
                           return !output.monitor.empty() || output.window.has_value();
                       });
    return shown ? Backend::glfw : kInMemory;
}

GlContext::GlContext(Backend backend, std::unique_ptr<GlPlatform> platform)
    : backend_(backend), platform_(std::move(platform)) {
    makeCurrent();
    const auto load = [](void* from, const char* name) -> GLADapiproc {
        return static_cast<GlPlatform*>(from)->functionNamed(name);
    };
    if (gladLoadGLUserPtr(load, platform_.get()) < GLAD_MAKE_VERSION(3, 3)) {
        throw base::InputError("the OpenGL context lacks functions of OpenGL 3.3; install or update the driver");
    }
}

std::string GlContext::name() const { return std::string(base::nameOf(backend_)); }

void GlContext::present(std::span<const OutputPicture> /* outputs */, const PixelRect& /* changed */,
                        std::uint64_t /* frame */) {
    finishFrame();
}

std::string GlContext::renderer() const {
    const auto text = [](GLenum key) {
        const GLubyte* words = glGetString(key);
        return words == nullptr ? std::string("?") : std::string(reinterpret_cast<const char*>(words));
    };
    return text(GL_RENDERER) + ", OpenGL " + text(GL_VERSION);
}

void GlContext::finishFrame() {
    glFinish();
    // Runs after 1, 2, 4, 8 … frames. A shader is compiled when it is first drawn with, and that becomes rarer with
    // time.
    if (std::has_single_bit(++frames_)) {
        giveBackCompilerMemory();
    }
}

PlatformRequest platformRequest(Backend backend, const walls::Wall& wall, const walls::Tile& tile,
                                const std::string& sceneName) {
    PlatformRequest request;
    request.processName = "rank " + std::to_string(tile.rank) + " (" + tile.name + ")";
    request.display = tile.place.display;
    request.device = tile.place.device;
    request.software = isSoftware(backend, tile);
    request.eyesInTurn = wall.stereo == walls::Stereo::active;
    request.refreshHz = wall.refreshHz;
    request.onDesk = wall.onDesk;
    if (backendFor(backend, tile) == Backend::glfw) {
        for (const walls::Output& output : tile.outputs) {
            request.windows.push_back({output, walls::outputPixels(wall.stereo, tile.pixels),
                                       walls::followsWindow(wall), titleOf(sceneName, wall, tile, output)});
        }
    }
    return request;
}

std::unique_ptr<GlContext> makeContext(Backend backend, const walls::Wall& wall, const walls::Tile& tile, bool pointer,
                                       const std::string& sceneName) {
    PlatformRequest request = platformRequest(backend, wall, tile, sceneName);
    request.pointer = pointer;
    if (pointer && request.windows.empty()) {
        throw base::InputError("--gl " + std::string(base::nameOf(backendFor(backend, tile))) +
                               ": draws without a window, but the pointer needs one; choose --gl glfw, or another "
                               "--device");
    }
    return contextOf(backendFor(backend, tile), request);
}

std::unique_ptr<GlContext> makeOffscreenContext(Backend backend) {
    PlatformRequest request;
    request.software = isSoftware(backend, {});
    return contextOf(backendFor(backend, {}), request);
}

}  // namespace render_node
