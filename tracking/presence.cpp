// SPDX-License-Identifier: Apache-2.0
#include "tracking/presence.hpp"

#include <fmt/format.h>

#include <chrono>

#include "host/event.hpp"

namespace tracking {

void Presence::look(bool pose, std::int64_t nowNs) {
    const std::int64_t silent = looked_ ? nowNs - last_ : 0;
    if (pose) {
        if (state_ == State::lost) {
            host::emitEvent("head_tracking", {{"state", "back"}});
            print_(fmt::format("head tracking: {} is back after {:.1f} s", what_, static_cast<double>(silent) * 1e-9));
        } else if (state_ == State::awaited) {
            print_(fmt::format("head tracking: {} is there", what_));
        }
        state_ = State::there;
        last_ = nowNs;
    } else if (silent > kLostAfterNs && state_ == State::there) {
        host::emitEvent("head_tracking", {{"state", "lost"}});
        print_(fmt::format("head tracking: no pose from {} for {:.1f} s; the last one is held", what_,
                           static_cast<double>(silent) * 1e-9));
        state_ = State::lost;
        ++timesLost_;
    } else if (silent > kLostAfterNs && state_ == State::unseen) {
        print_(fmt::format("head tracking: no pose from {} yet; the viewer stays where the wall file puts it", what_));
        state_ = State::awaited;
    }
    if (!looked_) {
        looked_ = true;
        last_ = nowNs;
    }
}

}  // namespace tracking
