// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "haptic_bridge/link/protocol.hpp"
#include "haptic_bridge/link/step_ring.hpp"

namespace haptic_bridge {

/// Commands of the streaming thread that wait for the sand thread. Their memory is limited, because a master may send
/// 50,000 messages a second while one step of a large field takes seconds.
///
/// The sand thread carries them out in the order of the members. That is the order in which a link can send them. A
/// command that makes an earlier one useless removes it. Not thread-safe; can be moved.
struct Commands {
    struct Grant {
        std::uint32_t session = 0;
        StartMessage start;
    };
    struct Frame {
        Shown shown;
        std::int64_t nowNs = 0;
    };
    struct Audit {};
    static constexpr std::size_t kMostFrames = 64;  // one second of a wall; of more, only the latest matter
    static constexpr std::size_t kMostCatchUps = StepRing::kSteps / kMaxCatchUp;

    bool stops = false;
    bool released = false;
    std::optional<Grant> grant;
    std::vector<CatchUp> catchUps;
    std::optional<State> state;
    std::deque<Frame> frames;
    std::optional<EditRequest> edit;
    bool audits = false;

    /// Ends the epoch. All commands of its master are removed.
    void release() {
        const bool stop = stops;
        *this = Commands();
        stops = stop;
        released = true;
    }
    void add(Grant granted) { grant = granted; }
    void add(CatchUp steps) {
        if (catchUps.size() < kMostCatchUps) {
            catchUps.push_back(std::move(steps));
        }
    }
    void add(State sand) { state = std::move(sand); }
    void add(const Frame& frame) {
        if (frames.size() == kMostFrames) {
            frames.pop_front();
        }
        frames.push_back(frame);
    }
    /// Replaces an edit that still waits, as StepMaker::edit() does.
    void add(EditRequest request) { edit = std::move(request); }
    void add(Audit) { audits = true; }

    [[nodiscard]] bool empty() const {
        return !stops && !released && !grant && catchUps.empty() && !state && frames.empty() && !edit && !audits;
    }
};

}  // namespace haptic_bridge
