// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/devices/mouse.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <future>

#include "host/clock.hpp"

namespace haptic_bridge {
namespace {

constexpr std::int64_t kFrameNs = 33'000'000;
constexpr double kHover = 3;            // [tool radius] above the surface while the button is up
constexpr double kDepthPerNotch = 0.1;  // [tool radius]
constexpr double kDeepest = 3;          // [tool radius], greatest depth of the underside

}  // namespace

MouseDevice::MouseDevice(const OpenWindow& open) {
    std::promise<void> opened;
    std::future<void> outcome = opened.get_future();
    thread_ = std::thread([this, &open, &opened] {
        std::unique_ptr<PictureWindow> window;
        try {
            window = open();
        } catch (...) {
            opened.set_exception(std::current_exception());
            return;
        }
        opened.set_value();
        run(*window);
    });
    try {
        outcome.get();
    } catch (...) {
        thread_.join();
        throw;
    }
}

MouseDevice::~MouseDevice() {
    stopping_ = true;
    thread_.join();
}

void MouseDevice::stepped(const sand::Replica& terrain) {
    const std::int64_t now = host::monotonicNs();
    if (sketchedNs_ == 0 || now - sketchedNs_ >= kFrameNs) {
        sketchedNs_ = now;
        sketch_.next().take(terrain);
        sketch_.publish();
    }
}

Pose MouseDevice::read(double) {
    const Hand& hand = hand_.latest();
    if (!hand.open) {
        troubles_.count(Trouble::absent);
    }
    return hand.pose;
}

void MouseDevice::sendForce(sand::force::Vec3 force) {
    force_.next() = share_.load(std::memory_order_relaxed) * force;
    force_.publish();
}

void MouseDevice::follow(const WindowInput& input) {
    const SandSketch& sand = sketch_.latest();
    if (sand.columns > 0 && input.width > 0 && input.height > 0) {
        const SketchFrame frame = SketchFrame::of(input.width, input.height, sand.columns, sand.rows);
        shown_.x = std::clamp(frame.handX(input.x), -frame.halfWidth, frame.halfWidth);
        shown_.y = std::clamp(frame.handY(input.y), -frame.halfHeight, frame.halfHeight);
    }
    // Turning the wheel towards the user lowers the tool into the sand.
    shown_.depth = std::clamp(shown_.depth - kDepthPerNotch * (input.wheel - wheel_), 0.0, kDeepest);
    wheel_ = input.wheel;
    shown_.touches = input.left && !input.closed;
    for (const char key : input.keys) {
        const double share = share_;
        share_ = key == 'f'   ? (share > 0 ? 0 : 1)
                 : key == '+' ? std::min(1.0, share + 0.1)
                 : key == '-' ? std::max(0.0, share - 0.1)
                              : share;
    }
    hand_.next() = {{shown_.x, shown_.y, shown_.touches ? 1 - shown_.depth : kHover, shown_.touches}, !input.closed};
    hand_.publish();
}

void MouseDevice::run(PictureWindow& window) {
    Picture picture;
    std::int64_t drawn = 0;
    while (!stopping_) {
        const WindowInput input = window.input();
        follow(input);
        if (input.closed) {
            return;
        }
        const std::int64_t now = host::monotonicNs();
        if (now - drawn >= kFrameNs && input.width > 0 && input.height > 0) {
            drawn = now;
            picture.width = input.width;
            picture.height = input.height;
            shown_.force = force_.latest();
            paint(sketch_.latest(), shown_, picture);
            window.show(picture);
        }
        // The window is read eight times per frame of the wall, because a path needs more points than there are frames.
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
}

}  // namespace haptic_bridge
