// SPDX-License-Identifier: Apache-2.0
// Module sandwall-gl-osmesa.so.
#include <GL/osmesa.h>

#include <array>

#include "base/input_error.hpp"
#include "render_node/gl/gl_platform.hpp"

namespace render_node {
namespace {

/// Platform in which Mesa draws into memory, without a window, a display server or a graphics card.
class Osmesa final : public GlPlatform {
public:
    Osmesa() : context_(create()) {}
    ~Osmesa() override { OSMesaDestroyContext(context_); }

    void makeCurrent(std::size_t /* context */) override {
        if (OSMesaMakeCurrent(context_, surface_.data(), GL_UNSIGNED_BYTE, kSide, kSide) != GL_TRUE) {
            throw base::InputError("OSMesa cannot make its OpenGL context current; reinstall libosmesa6");
        }
    }
    [[nodiscard]] GlFunction functionNamed(const char* name) override { return OSMesaGetProcAddress(name); }

private:
    static OSMesaContext create() {
        constexpr std::array<int, 13> kWanted{OSMESA_FORMAT,
                                              OSMESA_RGBA,
                                              OSMESA_DEPTH_BITS,
                                              0,
                                              OSMESA_STENCIL_BITS,
                                              0,
                                              OSMESA_PROFILE,
                                              OSMESA_CORE_PROFILE,
                                              OSMESA_CONTEXT_MAJOR_VERSION,
                                              3,
                                              OSMESA_CONTEXT_MINOR_VERSION,
                                              3,
                                              0};
        OSMesaContext context = OSMesaCreateContextAttribs(kWanted.data(), nullptr);
        if (context == nullptr) {
            throw base::InputError("OSMesa has no OpenGL 3.3 core; install Mesa's libosmesa6 22 or later");
        }
        return context;
    }

    static constexpr int kSide = 4;  // [pixel]; small, because everything is drawn into our own frame buffers
    std::array<unsigned char, 4 * kSide * kSide> surface_{};
    OSMesaContext context_;
};

}  // namespace

extern "C" GlPlatform* sandwallGlPlatform8(const PlatformRequest& /* request */) { return new Osmesa; }

}  // namespace render_node
