// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace haptic_bridge {

/// Pixels from the upper left, rows downwards: 0xAABBGGRR, which is R, G, B, A in memory.
struct Picture {
    int width = 0, height = 0;
    std::vector<std::uint32_t> pixels;
};

/// What a person does with mouse and keys.
struct WindowInput {
    int width = 0, height = 0;  // [pixel], of the picture that fits now
    double x = 0, y = 0;        // [pixel], of the pointer, from the upper left
    double wheel = 0;           // notches since the start, away from the person
    bool left = false;          // held
    std::string keys;           // pressed since this was asked last
    bool closed = false;
};

/// A window that shows a picture. Opened, used and closed by one thread. What it is made with is its module's business.
class PictureWindow {
public:
    PictureWindow() = default;
    virtual ~PictureWindow() = default;
    PictureWindow(const PictureWindow&) = delete;
    PictureWindow& operator=(const PictureWindow&) = delete;
    [[nodiscard]] virtual WindowInput input() = 0;
    virtual void show(const Picture& picture) = 0;
};

/// What sandwall-window.so defines, with C linkage. Throws std::exception with a line for a person.
inline constexpr const char* kPictureWindowSymbol = "sandwallPictureWindow1";
using OpenPictureWindow = PictureWindow*(const char* title, int width, int height);

}  // namespace haptic_bridge
