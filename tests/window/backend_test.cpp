// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>

#include "base/input_error.hpp"
#include "pictures/compare.hpp"
#include "render_node/gl/gl_module.hpp"
#include "tests/support/screens/x_server.hpp"
#include "tests/window/probe_fixture.hpp"

namespace {

using render_node::Backend;

class Backends : public ProbeTest {
protected:
    std::vector<std::string> arguments(const std::string& gl) {
        if (gl == "glfw" && !server_) {
            server_ = std::make_unique<support::XServer>(folder_, std::vector<std::string>{"1100x800x24"});
        }
        return gl == "glfw" ? std::vector<std::string>{"--gl", gl, "--at", "0,0", "--display", server_->display()}
                            : std::vector<std::string>{"--gl", gl};
    }
    std::unique_ptr<support::XServer> server_;
};

TEST_F(Backends, MapTheirOwnLibrariesAndNoOthers) {
    const std::map<std::string, std::string> own{{"osmesa", "libOSMesa"}, {"egl", "libEGL"}, {"glfw", "libglfw"}};
    for (const auto& [gl, library] : own) {
        const std::vector<std::string> loaded = linesOf(startAndShow(arguments(gl)), "library");
        const auto has = [&](const std::string& name) {
            return std::any_of(loaded.begin(), loaded.end(), [&](const std::string& l) { return l.starts_with(name); });
        };
        for (const auto& [other, foreign] : own) {
            EXPECT_EQ(has(foreign), other == gl) << foreign << " with " << gl;
            EXPECT_EQ(has("sandwall-gl-" + other + ".so"), other == gl) << other << " with " << gl;
        }
        if (gl != "glfw") {
            EXPECT_FALSE(has("libX11.so")) << gl;
            EXPECT_FALSE(has("libGLX")) << gl;
        }
        probe_.reset();
    }
}

// With these variables OSMesa would end the process by SIGSEGV, or refuse OpenGL 3.3.
TEST_F(Backends, NameTheVariableOfMesaThatLeavesNoContext) {
    const std::map<std::string, std::string> refused{
        {"GALLIUM_DRIVER=zink", "OSMesa has only the drivers llvmpipe and softpipe"},
        {"GALLIUM_DRIVER=nonsense", "OSMesa has only the drivers llvmpipe and softpipe"},
        {"MESA_GL_VERSION_OVERRIDE=2.1", "takes away OpenGL 3.3"},
        {"MESA_GL_VERSION_OVERRIDE=3.2COMPAT", "takes away OpenGL 3.3"},
        {"MESA_GLSL_VERSION_OVERRIDE=120", "takes away GLSL 3.30"},
        {"MESA_EXTENSION_OVERRIDE=-GL_ARB_uniform_buffer_object", "takes extensions away"}};
    for (const auto& [variable, words] : refused) {
        start(arguments("osmesa"), {variable});
        const std::string line = lastLine(2);
        EXPECT_TRUE(line.starts_with("window_probe: " + variable + ": " + words)) << line;
        EXPECT_NE(line.find("; unset it"), std::string::npos) << line;
    }
    for (const std::string gl : {"egl", "glfw"}) {
        start(arguments(gl), {"MESA_GL_VERSION_OVERRIDE=2.1"});
        const std::string line = lastLine(2);
        EXPECT_NE(line.find("; try again without MESA_GL_VERSION_OVERRIDE=2.1, which changes what Mesa offers\n"),
                  std::string::npos)
            << line;
    }
}

TEST_F(Backends, TakeVariablesOfMesaThatLeaveAContext) {
    for (const char* variable : {"GALLIUM_DRIVER=", "GALLIUM_DRIVER=llvmpipe", "MESA_GL_VERSION_OVERRIDE=4.1",
                                 "MESA_GLSL_VERSION_OVERRIDE=330", "MESA_EXTENSION_OVERRIDE=+GL_ARB_made_up"}) {
        (void)startAndShow(arguments("osmesa"), {variable});
        probe_.reset();
    }
}

TEST_F(Backends, DrawTheSamePicture) {
    std::map<std::string, std::map<std::string, pictures::Image>> drawn;
    for (const std::string gl : {"osmesa", "egl", "glfw"}) {
        std::vector<std::string> words = arguments(gl);
        (void)startAndShow(words);
        for (const std::string eye : {"left", "right"}) {
            drawn[gl][eye] = picture(eye);
        }
        probe_.reset();
    }
    for (const std::string gl : {"egl", "glfw"}) {
        for (const std::string eye : {"left", "right"}) {
            const pictures::Comparison difference = pictures::compare(drawn["osmesa"][eye], drawn[gl][eye], 8);
            EXPECT_LE(difference.badShare, 0.01) << gl << " " << eye;
            std::printf("%s, %s eye: largest difference %d levels\n", gl.c_str(), eye.c_str(),
                        difference.largestDifference);
        }
    }
    // The bound distinguishes pictures that are not the same.
    EXPECT_GT(pictures::compare(drawn["osmesa"]["left"], drawn["osmesa"]["right"], 8).badShare, 0.01);
}

TEST_F(Backends, NeedLittleMemoryBesideTheFrameBuffers) {
    for (const std::string gl : {"osmesa", "egl", "glfw"}) {
        std::vector<std::string> words = arguments(gl);
        words.insert(words.end(), {"--width", "1024", "--height", "768", "--cells", "512"});
        (void)startAndShow(words, {"MESA_SHADER_CACHE_DISABLE=true"});  // compiles the shaders as in a first run
        for (int frame = 1; frame < 5; ++frame) {
            (void)ask("frame " + std::to_string(frame), "frame " + std::to_string(frame) + " shown");
        }
        const std::string output = ask("memory", "memory printed");
        const double megabytes = std::stod(linesOf(output, "resident").at(0)) / 1e6;
        const double frameBuffers = std::stod(linesOf(output, "frame_buffers").at(0)) / 1e6;
        std::printf("%s: %.0f MB and %.0f MB of frame buffers\n", gl.c_str(), megabytes - frameBuffers, frameBuffers);
        EXPECT_LE(megabytes - frameBuffers, 100) << gl << ": a rank has 120 MB, and MPI takes a part of it";
        EXPECT_GT(megabytes - frameBuffers, 10) << gl << ": the figure cannot be right";
        probe_.reset();
    }
}

TEST_F(Backends, AutoOpensWindowsOnlyWhereTheWallFileNamesAPlace) {
    walls::Tile tile;
    tile.outputs = {{"left", {walls::Eye::left}, {}, {}}, {"right", {walls::Eye::right}, {}, {}}};
    EXPECT_EQ(render_node::backendFor(Backend::automatic, tile), render_node::kInMemory);
    walls::Tile display = tile;
    display.place.display = ":0.1";
    walls::Tile monitor = tile;
    monitor.outputs[1].monitor = "DP-2";
    walls::Tile window = tile;
    window.outputs[1].window = glm::ivec2(0, 0);
    for (const walls::Tile& shown : {display, monitor, window}) {
        EXPECT_EQ(render_node::backendFor(Backend::automatic, shown), Backend::glfw);
        EXPECT_EQ(render_node::backendFor(Backend::egl, shown), Backend::egl) << "an explicit choice is kept";
    }
}

TEST_F(Backends, NameThePackageOfAModuleThatIsNotThere) {
    try {
        (void)render_node::loadPlatform(Backend::egl, {}, {folder_});
        FAIL() << "loaded from an empty folder";
    } catch (const base::InputError& error) {
        EXPECT_EQ(std::string(error.what()), "--gl egl: there is no sandwall-gl-egl.so in " + folder_.string() +
                                                 "; build Sandwall with Debian's libegl-dev");
    }
}

TEST_F(Backends, NameThePackageOfALibraryThatIsNotThere) {
    // The loader refuses a file that is not a library. A library with missing dependencies gives the same error.
    std::ofstream(folder_ / "sandwall-gl-glfw.so") << "not a library";
    try {
        (void)render_node::loadPlatform(Backend::glfw, {}, {folder_});
        FAIL() << "loaded a text file";
    } catch (const base::InputError& error) {
        const std::string line = error.what();
        EXPECT_TRUE(line.starts_with("--gl glfw: ")) << line;
        EXPECT_NE(line.find("install Debian's libglfw3,"), std::string::npos) << line;
        EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    }
}

TEST_F(Backends, EglTakesTheDeviceWithTheGivenNumber) {
    (void)startAndShow({"--gl", "egl"});
    const pictures::Image surfaceless = picture("left");
    // Mesa's software renderer is always a device. On a machine with graphics cards it is not the first device, and the
    // numbers differ.
    const std::string output = startAndShow({"--gl", "egl", "--device", "0"});
    EXPECT_EQ(linesOf(output, "context").at(0), "egl");
    EXPECT_LE(pictures::compare(surfaceless, picture("left"), 8).badShare, 0.01);
}

TEST_F(Backends, EglListsTheDevicesThereAreForOneThatIsNot) {
    start({"--gl", "egl", "--device", "99"});
    const std::string line = lastLine(2);
    EXPECT_TRUE(line.starts_with("window_probe: no EGL device 99; there are 0 (")) << line;
}

TEST_F(Backends, EglWithoutADriverIsOneLine) {
    for (const std::string device : {"-1", "0"}) {
        start({"--gl", "egl", "--device", device}, {"__EGL_VENDOR_LIBRARY_DIRS=" + folder_.string()});
        EXPECT_NE(lastLine(2).find("install libegl-mesa0"), std::string::npos);
    }
}

}  // namespace
