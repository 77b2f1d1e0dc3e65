// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render_node/gl/gl_platform.hpp"

namespace render_node {

/// Finds the releases of buttons that no window gets. If a window is hidden while a button is held in it, the window
/// system sends the release to another program. The tool would stay in the sand.
///
/// The owner follows all events, and looks at the buttons of the pointer itself while one of them is held. A press that
/// the pointer itself does not know, because a program has sent it, is never taken back. Used by one thread.
class ButtonWatch {
public:
    static constexpr std::int64_t kPause = 50'000'000;  // [ns] between two looks

    /// Buttons of the pointer that are down.
    struct Down {
        bool left = false, view = false;  // view: the right or the middle button
    };

    /// Follows the next events.
    void follow(std::span<const PointerEvent> events);
    /// Returns whether to look at the buttons now. `nowNs` is a monotonic clock.
    [[nodiscard]] bool due(std::int64_t nowNs) const;
    /// Returns a release for each button whose release is lost: it was up at two looks, and no release has come.
    [[nodiscard]] std::vector<PointerEvent> look(Down down, std::int64_t nowNs);

private:
    struct Button {
        bool held = false;     // by the events
        bool seen = false;     // the pointer itself had it down
        bool missing = false;  // it was up at the last look
        PointerEvent last;     // of its window, where the release is placed

        void follow(const PointerEvent& event, bool presses, bool releases);
        [[nodiscard]] bool isLost(bool down);
    };

    Button left_, view_;
    std::int64_t looked_ = 0;  // [ns]
};

}  // namespace render_node
