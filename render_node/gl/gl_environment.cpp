// SPDX-License-Identifier: Apache-2.0
#include "render_node/gl/gl_environment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <string_view>

namespace render_node {
namespace {

std::string_view valueOf(const char* name) {
    const char* value = std::getenv(name);
    return value == nullptr ? std::string_view() : std::string_view(value);
}

/// Returns "NAME=VALUE" in one line of bounded length.
std::string setting(const char* name) {
    std::string value(valueOf(name).substr(0, 80));
    std::ranges::replace_if(
        value, [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
    return fmt::format("{}={}", name, value);
}

/// Returns whether a text begins with a version that is below `least`, such as "2.1COMPAT" below 3.3.
bool isBelow(std::string_view text, double least) {
    double version = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), version);
    return error == std::errc() && version < least;
}

}  // namespace

std::string environmentFault(Backend backend) {
    // Mesa ends the process by SIGSEGV if an extension is missing that its version of OpenGL contains.
    if (valueOf("MESA_EXTENSION_OVERRIDE").find("-GL_") != std::string_view::npos) {
        return setting("MESA_EXTENSION_OVERRIDE") + ": takes extensions away without which Mesa may end; unset it";
    }
    if (backend != Backend::osmesa) {
        return {};
    }
    const std::string_view driver = valueOf("GALLIUM_DRIVER");
    if (!driver.empty() && driver != "llvmpipe" && driver != "softpipe") {
        return setting("GALLIUM_DRIVER") +
               ": OSMesa has only the drivers llvmpipe and softpipe, and ends with any other; unset it, or choose "
               "another --gl";
    }
    if (isBelow(valueOf("MESA_GL_VERSION_OVERRIDE"), 3.3)) {
        return setting("MESA_GL_VERSION_OVERRIDE") + ": takes away OpenGL 3.3, which Sandwall needs; unset it";
    }
    if (isBelow(valueOf("MESA_GLSL_VERSION_OVERRIDE"), 330)) {
        return setting("MESA_GLSL_VERSION_OVERRIDE") + ": takes away GLSL 3.30, which Sandwall needs; unset it";
    }
    return {};
}

std::string environmentHint() {
    constexpr std::array kVariables{"GALLIUM_DRIVER",           "MESA_LOADER_DRIVER_OVERRIDE",
                                    "MESA_GL_VERSION_OVERRIDE", "MESA_GLSL_VERSION_OVERRIDE",
                                    "MESA_EXTENSION_OVERRIDE",  "LIBGL_ALWAYS_INDIRECT"};
    std::string words;
    for (const char* name : kVariables) {
        if (!valueOf(name).empty()) {
            words += (words.empty() ? "" : " and ") + setting(name);
        }
    }
    return words.empty() ? "" : "; try again without " + words + ", which changes what Mesa offers";
}

}  // namespace render_node
