// SPDX-License-Identifier: Apache-2.0
// The only file here that uses GLFW. It is a module of its own, so that no other device loads GLFW.
#include <GLFW/glfw3.h>

#include <stdexcept>

#include "haptic_bridge/devices/picture_window.hpp"

namespace {

using haptic_bridge::Picture;
using haptic_bridge::WindowInput;

class GlfwWindow : public haptic_bridge::PictureWindow {
public:
    GlfwWindow(const char* title, int width, int height) {
        if (glfwInit() == GLFW_FALSE) {
            throw std::runtime_error("no window can be opened; set DISPLAY to an X display");
        }
        // The oldest OpenGL draws a picture in one call, and every driver supports it.
        window_ = glfwCreateWindow(width, height, title, nullptr, nullptr);
        if (window_ == nullptr) {
            glfwTerminate();
            throw std::runtime_error("the display opens no window with OpenGL");
        }
        glfwSetWindowUserPointer(window_, this);
        glfwSetScrollCallback(window_, [](GLFWwindow* window, double, double up) { of(window).input_.wheel += up; });
        glfwSetCharCallback(window_, [](GLFWwindow* window, unsigned int letter) {
            if (letter < 0x80) {
                of(window).input_.keys.push_back(static_cast<char>(letter));
            }
        });
        glfwMakeContextCurrent(window_);
        glfwSwapInterval(0);
        rasterPos_ = function<void(float, float)>("glRasterPos2f");
        drawPixels_ = function<void(GLsizei, GLsizei, GLenum, GLenum, const void*)>("glDrawPixels");
        pixelZoom_ = function<void(float, float)>("glPixelZoom");
        viewport_ = function<void(GLint, GLint, GLsizei, GLsizei)>("glViewport");
    }
    ~GlfwWindow() override {
        glfwDestroyWindow(window_);
        glfwTerminate();
    }

    WindowInput input() override {
        glfwPollEvents();
        int across = 1, down = 1;
        glfwGetWindowSize(window_, &across, &down);
        glfwGetFramebufferSize(window_, &input_.width, &input_.height);
        glfwGetCursorPos(window_, &input_.x, &input_.y);
        // A screen coordinate may be several pixels of the picture.
        input_.x *= across > 0 ? static_cast<double>(input_.width) / across : 1;
        input_.y *= down > 0 ? static_cast<double>(input_.height) / down : 1;
        input_.left = glfwGetMouseButton(window_, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS;
        input_.closed = glfwWindowShouldClose(window_) != GLFW_FALSE;
        WindowInput now = input_;
        input_.keys.clear();
        return now;
    }
    void show(const Picture& picture) override {
        viewport_(0, 0, picture.width, picture.height);
        rasterPos_(-1, 1);
        pixelZoom_(1, -1);  // rows downwards
        drawPixels_(picture.width, picture.height, GL_RGBA, GL_UNSIGNED_BYTE, picture.pixels.data());
        glfwSwapBuffers(window_);
    }

private:
    static GlfwWindow& of(GLFWwindow* window) { return *static_cast<GlfwWindow*>(glfwGetWindowUserPointer(window)); }
    template <class Function>
    static Function* function(const char* name) {
        const auto address = glfwGetProcAddress(name);
        if (address == nullptr) {
            throw std::runtime_error(std::string("the display's OpenGL has no ") + name);
        }
        return reinterpret_cast<Function*>(address);
    }

    GLFWwindow* window_ = nullptr;
    WindowInput input_;
    void (*rasterPos_)(float, float) = nullptr;
    void (*drawPixels_)(GLsizei, GLsizei, GLenum, GLenum, const void*) = nullptr;
    void (*pixelZoom_)(float, float) = nullptr;
    void (*viewport_)(GLint, GLint, GLsizei, GLsizei) = nullptr;
};

}  // namespace

extern "C" haptic_bridge::PictureWindow* sandwallPictureWindow1(const char* title, int width, int height) {
    return new GlfwWindow(title, width, height);
}
