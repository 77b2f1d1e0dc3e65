// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace haptic_bridge {

/// Picture, with rows downwards from the upper left corner. A pixel is 0xAABBGGRR, which is R, G, B, A in memory.
struct Picture {
    int width = 0, height = 0;
    std::vector<std::uint32_t> pixels;
};

/// Input of the user with mouse and keys.
struct WindowInput {
    int width = 0, height = 0;  // [pixel], size of a picture that fits the window
    double x = 0, y = 0;        // [pixel], place of the pointer, from the upper left
    double wheel = 0;           // [notch] since the start, positive away from the user
    bool left = false;          // the left button is held
    std::string keys;           // keys pressed since the last call
    bool closed = false;
};

/// A window that shows a picture. One thread opens, uses and closes it. Its module decides which library draws it.
class PictureWindow {
public:
    PictureWindow() = default;
    virtual ~PictureWindow() = default;
    PictureWindow(const PictureWindow&) = delete;
    PictureWindow& operator=(const PictureWindow&) = delete;
    [[nodiscard]] virtual WindowInput input() = 0;
    virtual void show(const Picture& picture) = 0;
};

/// Name of the function that sandwall-window.so defines, with C linkage. The function throws std::exception with one
/// line for the user.
inline constexpr const char* kPictureWindowSymbol = "sandwallPictureWindow1";
using OpenPictureWindow = PictureWindow*(const char* title, int width, int height);

}  // namespace haptic_bridge
