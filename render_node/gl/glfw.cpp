// SPDX-License-Identifier: Apache-2.0
// Module sandwall-gl-glfw.so.
#define GLFW_INCLUDE_NONE
#define GLFW_EXPOSE_NATIVE_X11
#define GLFW_EXPOSE_NATIVE_GLX
#include <GLFW/glfw3.h>
#include <GLFW/glfw3native.h>

#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>
#include <utility>

#include "base/input_error.hpp"
#include "host/clock.hpp"
#include "render_node/gl/button_watch.hpp"
#include "render_node/gl/gl_platform.hpp"
#include "render_node/gl/glfw_window.hpp"
#include "render_node/gl/monitor_follower.hpp"
#include "render_node/gl/part_copy.hpp"
#include "render_node/gl/swap_sync.hpp"
#include "render_node/gl/x_watch.hpp"

namespace render_node {
namespace {

/// Platform with windows on an X display.
class Glfw final : public GlPlatform {
public:
    explicit Glfw(const PlatformRequest& request)
        : watch_(request.display, request.processName, request.pointer),
          eyesInTurn_(request.eyesInTurn),
          mayClose_(request.pointer || request.onDesk) {
        if (request.windows.empty()) {
            hidden_.emplace(library_, watch_.name());
        }
        for (const WindowRequest& wanted : request.windows) {
            windows_.emplace_back(library_, watch_.name(), wanted, request,
                                  windows_.empty() ? nullptr : windows_.front().handle());
        }
        std::vector<unsigned long> ids;
        std::vector<GlxDrawable> drawables;
        for (GlfwWindow& window : windows_) {
            ids.push_back(glfwGetX11Window(window.handle()));
            drawables.push_back(glfwGetGLXWindow(window.handle()));
            window.sendInputTo(input_, ids.size() - 1, request.pointer);
        }
        watch_.watch(ids);
        followMonitors();
        makeCurrent(0);
        if (!request.windows.empty()) {
            lockSwaps(drawables);
        }
    }
    ~Glfw() override { makeCurrent(0); }

    void makeCurrent(std::size_t context) override {
        glfwMakeContextCurrent((hidden_ ? *hidden_ : windows_.at(context)).handle());
    }
    [[nodiscard]] GlFunction functionNamed(const char* name) override { return glfwGetProcAddress(name); }

    [[nodiscard]] bool quadBuffers(std::size_t window) const override { return windows_.at(window).quadBuffers(); }

    void check() override {
        const int lost = watch_.firstLost();
        if (lost >= 0) {
            throw std::runtime_error("output " + windows_[static_cast<std::size_t>(lost)].name() + ": its window on " +
                                     watch_.name() + " is gone");
        }
        glfwPollEvents();
        if (follower_) {
            follower_->follow();
        }
        for (const GlfwWindow& window : windows_) {
            if (glfwWindowShouldClose(window.handle()) != 0 && (mayClose_ || !window.isPlaced())) {
                glfwSetWindowShouldClose(window.handle(), GLFW_FALSE);
                input_->keys.push_back(base::kCloseKey);
            } else if (glfwWindowShouldClose(window.handle()) != 0) {
                throw std::runtime_error("output " + window.name() + ": its window on " + watch_.name() +
                                         " was closed");
            }
        }
    }

    [[nodiscard]] std::vector<base::MonitorState> monitorStates() const override {
        std::vector<base::MonitorState> states;
        for (std::size_t i = 0; i < windows_.size(); ++i) {
            states.push_back(follower_ ? follower_->state(i) : base::MonitorState::on);
        }
        return states;
    }
    [[nodiscard]] glm::ivec2 followedSize(std::size_t window) const override {
        return windows_.at(window).followedPixels();
    }
    // Mesa's software renderer gives a back buffer its new size only after a swap. Until then a copy of a part beyond
    // the former size is refused by the X server (MIT-SHM, BadValue), which would end the rank.
    void resized(std::size_t window) override { wholeSwaps_.at(window) = kWholeSwaps; }
    [[nodiscard]] bool takeExposed(std::size_t window) override { return windows_.at(window).takeExposed(); }
    [[nodiscard]] bool keepsPicture(std::size_t window) const override {
        return parts_.at(window).has_value() && wholeSwaps_.at(window) == 0;
    }

    void swap(std::uint64_t frame, std::span<const PixelRect> changed) override {
        for (std::size_t i = 0; i < windows_.size(); ++i) {
            if (keepsPicture(i)) {
                if (!changed[i].empty()) {
                    parts_[i]->show(changed[i]);
                }
            } else if (!eyes_[i] || !eyes_[i]->swap(frame)) {
                glfwSwapBuffers(windows_[i].handle());
                wholeSwaps_[i] = std::max(0, wholeSwaps_[i] - 1);
            }
        }
    }

    [[nodiscard]] std::vector<base::Keystroke> takeKeys() override {
        check();
        return std::exchange(input_->keys, {});
    }
    [[nodiscard]] std::vector<PointerEvent> takePointer() override {
        check();
        std::vector<PointerEvent> events = std::exchange(input_->pointer, {});
        buttons_.follow(events);
        if (const std::int64_t now = host::monotonicNs(); buttons_.due(now)) {
            const std::vector<PointerEvent> lost = buttons_.look(watch_.buttons(), now);
            events.insert(events.end(), lost.begin(), lost.end());
        }
        return events;
    }
    void awaitEvents(double seconds) override { glfwWaitEventsTimeout(seconds); }

    [[nodiscard]] std::vector<std::string> shortcomings() const override {
        std::vector<std::string> lines;
        for (std::size_t i = 0; i < windows_.size(); ++i) {
            if (eyesInTurn_ && !windows_[i].quadBuffers()) {
                lines.push_back("output " + windows_[i].name() + ": no quad buffers; eyes in turn by frame" +
                                (eyes_[i] ? "" : ", without a count of retraces to keep them to"));
            }
            windows_[i].addShortcomings(lines);
        }
        return lines;
    }
    [[nodiscard]] std::optional<ScreenRect> workArea() const override { return render_node::workArea(); }
    [[nodiscard]] std::string swapLock() const override { return group_ ? group_->state() : "none"; }
    [[nodiscard]] int framesToIgnore() const override { return group_ ? group_->framesToIgnore() : 0; }

private:
    void followMonitors() {
        for (std::size_t i = 0; i < windows_.size(); ++i) {
            if (!windows_[i].wanted().output.monitor.empty()) {
                if (!follower_) {
                    follower_.emplace(watch_.name());
                }
                follower_->add(windows_[i].handle(), windows_[i].wanted(), windows_[i].refreshRate(), i);
            }
        }
    }
    void lockSwaps(const std::vector<GlxDrawable>& drawables) {
        const GlxLoader loader{[](const char* name) { return glfwExtensionSupported(name) != 0; },
                               [](const char* name) { return glfwGetProcAddress(name); }, glfwGetX11Display(),
                               displayScreen()};
        group_.emplace(loader, drawables);
        eyes_.resize(windows_.size());
        parts_.resize(windows_.size());
        wholeSwaps_.resize(windows_.size());
        for (std::size_t i = 0; i < windows_.size(); ++i) {
            const bool inTurn = eyesInTurn_ && !windows_[i].quadBuffers();
            if (inTurn) {
                eyes_[i].emplace(loader, drawables[i]);
                if (!eyes_[i]->available()) {
                    eyes_[i].reset();
                }
            }
            // Other windows do not wait for a retrace. The software barrier paces them, and a second wait would only
            // delay the ranks.
            makeCurrent(i);
            const bool retrace = inTurn || group_->joined();
            glfwSwapInterval(retrace ? 1 : 0);
            if (!retrace && !windows_[i].quadBuffers()) {
                parts_[i].emplace(loader, drawables[i]);
                if (!parts_[i]->available()) {
                    parts_[i].reset();
                }
            }
        }
        makeCurrent(0);
    }

    // The order matters. The windows are destroyed first, then the library, then the handlers of X errors.
    XWatch watch_;
    GlfwLibrary library_;
    std::optional<GlfwWindow> hidden_;  // off screen, for its context
    std::vector<GlfwWindow> windows_;
    std::optional<MonitorFollower> follower_;  // nullopt if no output names a monitor
    std::shared_ptr<WindowInput> input_ = std::make_shared<WindowInput>();
    ButtonWatch buttons_;
    bool eyesInTurn_;
    bool mayClose_;  // whether a user who closes a window ends the session
    std::optional<SwapGroup> group_;
    std::vector<std::optional<EyesByRetrace>> eyes_;
    static constexpr int kWholeSwaps = 30;  // [frame] after a change of size: one swap, and a margin for more changes

    std::vector<std::optional<PartCopy>> parts_;
    std::vector<int> wholeSwaps_;  // [frame], for which each window is still swapped as a whole
};

}  // namespace

extern "C" GlPlatform* sandwallGlPlatform8(const PlatformRequest& request) { return new Glfw(request); }

}  // namespace render_node
