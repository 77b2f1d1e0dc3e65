// SPDX-License-Identifier: Apache-2.0
// Module sandwall-gl-egl.so.
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/input_error.hpp"
#include "render_node/gl/gl_platform.hpp"

namespace render_node {
namespace {

using base::InputError;

/// Returns whether a list such as "EGL_KHR_image EGL_KHR_fence_sync" contains the name.
bool lists(const char* extensions, std::string_view name) {
    std::istringstream words(extensions == nullptr ? "" : extensions);
    return std::find(std::istream_iterator<std::string>(words), {}, name) != std::istream_iterator<std::string>();
}

template <class Function>
Function load(const char* name) {
    return reinterpret_cast<Function>(eglGetProcAddress(name));
}

/// List of EGL's devices: the graphics cards and Mesa's software renderer.
class Devices {
public:
    Devices() {
        const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
        if (!lists(client, "EGL_EXT_device_base") && !lists(client, "EGL_EXT_device_enumeration")) {
            return;
        }
        const auto query = load<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
        EGLint count = 0;
        if (query == nullptr || query(0, nullptr, &count) != EGL_TRUE || count < 1) {
            return;
        }
        devices_.resize(static_cast<std::size_t>(count));
        (void)query(count, devices_.data(), &count);
        devices_.resize(static_cast<std::size_t>(count));
    }
    [[nodiscard]] EGLDeviceEXT at(int number) const {
        if (number >= static_cast<int>(devices_.size())) {
            throw InputError("no EGL device " + std::to_string(number) + "; " + list());
        }
        return devices_[static_cast<std::size_t>(number)];
    }
    /// Returns the number of Mesa's software renderer.
    [[nodiscard]] int software() const {
        const auto query = load<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
        for (std::size_t i = 0; query != nullptr && i < devices_.size(); ++i) {
            if (lists(query(devices_[i], EGL_EXTENSIONS), "EGL_MESA_device_software")) {
                return static_cast<int>(i);
            }
        }
        throw InputError(
            "--gl auto: EGL has no software device; install libgl1-mesa-dri and libegl-mesa0, or choose another "
            "--gl; " +
            list());
    }
    /// Returns a text such as "there are 0 (/dev/dri/card0), 1 (software)".
    [[nodiscard]] std::string list() const {
        std::string text;
        for (std::size_t i = 0; i < devices_.size(); ++i) {
            text += (i == 0 ? "there are " : ", ") + std::to_string(i) + " (" + name(devices_[i]) + ")";
        }
        return text.empty() ? "there is no EGL device: install libegl-mesa0 or the graphics card's driver" : text;
    }

private:
    static std::string name(EGLDeviceEXT device) {
        const auto query = load<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
        if (query == nullptr) {
            return "nameless";
        }
        const char* extensions = query(device, EGL_EXTENSIONS);
        for (const auto& [extension, key] : {std::pair{"EGL_EXT_device_query_name", EGL_RENDERER_EXT},
                                             {"EGL_EXT_device_drm", EGL_DRM_DEVICE_FILE_EXT}}) {
            const char* text = lists(extensions, extension) ? query(device, key) : nullptr;
            if (text != nullptr && *text != '\0') {
                return text;
            }
        }
        return lists(extensions, "EGL_MESA_device_software") ? "software" : "nameless";
    }
    std::vector<EGLDeviceEXT> devices_;
};

EGLDisplay surfaceless() {
    if (!lists(eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS), "EGL_MESA_platform_surfaceless")) {
        throw InputError("this EGL has no surfaceless platform; give the tile's place in the wall file a device: " +
                         Devices().list());
    }
    return eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
}

/// Platform that draws off screen, on a graphics card or in Mesa's software renderer.
class Egl final : public GlPlatform {
public:
    explicit Egl(int device)
        : where_(device < 0 ? "EGL's surfaceless platform" : "EGL device " + std::to_string(device)),
          display_(device < 0 ? surfaceless()
                              : eglGetPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, Devices().at(device), nullptr)) {
        if (display_ == EGL_NO_DISPLAY || eglInitialize(display_, nullptr, nullptr) != EGL_TRUE) {
            throw InputError(where_ + " cannot be opened; " + Devices().list());
        }
        context_ = create();
        if (context_ == EGL_NO_CONTEXT) {
            eglTerminate(display_);
            throw InputError(where_ + " has no OpenGL 3.3 core; " + Devices().list());
        }
    }
    ~Egl() override {
        eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglDestroyContext(display_, context_);
        eglTerminate(display_);
    }

    void makeCurrent(std::size_t /* context */) override {
        // EGL keeps the API of new contexts for each thread and starts with OpenGL ES.
        eglBindAPI(EGL_OPENGL_API);
        if (eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) != EGL_TRUE) {
            throw InputError(where_ + " makes no OpenGL context current without a surface; " + Devices().list());
        }
    }
    [[nodiscard]] GlFunction functionNamed(const char* name) override { return eglGetProcAddress(name); }

private:
    [[nodiscard]] EGLContext create() const {
        if (eglBindAPI(EGL_OPENGL_API) != EGL_TRUE) {
            return EGL_NO_CONTEXT;
        }
        // No type of surface is needed, because everything is drawn into our own frame buffers.
        constexpr std::array<EGLint, 5> kConfig{EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
        EGLConfig config = nullptr;
        EGLint count = 0;
        if (eglChooseConfig(display_, kConfig.data(), &config, 1, &count) != EGL_TRUE || count < 1) {
            return EGL_NO_CONTEXT;
        }
        constexpr std::array<EGLint, 7> kWanted{
            EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
            EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
        return eglCreateContext(display_, config, EGL_NO_CONTEXT, kWanted.data());
    }

    std::string where_;
    EGLDisplay display_;
    EGLContext context_ = EGL_NO_CONTEXT;
};

}  // namespace

extern "C" GlPlatform* sandwallGlPlatform8(const PlatformRequest& request) {
    return new Egl(request.software ? Devices().software() : request.device);
}

}  // namespace render_node
