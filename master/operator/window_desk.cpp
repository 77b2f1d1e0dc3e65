// SPDX-License-Identifier: Apache-2.0
#include "master/operator/window_desk.hpp"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "base/input_error.hpp"
#include "host/clock.hpp"
#include "host/print_line.hpp"
#include "master/journal/saved_sand.hpp"

namespace master {

WindowDesk::WindowDesk(const scene::Scene& scene, std::filesystem::path out, bool pointer, Desk desk)
    : desk_(std::move(desk)),
      sceneMaterial_(scene.material),
      toolLimits_(haptic_bridge::ToolLimits::of(scene)),
      out_(std::move(out)),
      pointer_(pointer) {}

void WindowDesk::frameView() {
    if (desk_.views.moves()) {  // because to find the lowest and the highest sand takes a while
        desk_.views.frame(desk_.heights());
    }
}

void WindowDesk::obey(base::Keystroke key, int rank, std::int64_t nowNs) {
    using base::Keystroke;
    const std::optional<lockstep::KeyFound> found = lockstep::findKey(key);
    if (!found && pointer_ && key.repeated == 0 &&
        (key.modifiers & (Keystroke::kSuper | Keystroke::kAlt)) == 0) {  // those belong to the desktop
        answer(rank, kNoSuchKey);
    }
    if (!found || !(pointer_ || found->entry.everySession)) {
        return;
    }
    if (found->entry.action == lockstep::KeyAction::leave) {
        leave(*found, rank, nowNs);
    } else {
        obey(*found, rank);
    }
}

void WindowDesk::leave(const lockstep::KeyFound& found, int rank, std::int64_t nowNs) {
    if (desk_.views.layers().shows(lockstep::Overlay::help)) {
        obey(found, rank);
    } else if (askedNs_ && nowNs - *askedNs_ <= kLeaveNs) {
        desk_.carryOut("stop", rank);
    } else {
        askedNs_ = nowNs;
        answer(rank, kEndsByAnother);
    }
}

void WindowDesk::obey(const lockstep::KeyFound& found, int rank) {
    using lockstep::KeyAction;
    const KeyAction action = found.entry.action;
    if (action == KeyAction::frameView) {
        if (!desk_.views.moves()) {
            answer(rank, kFixedView);
            return;
        }
        frameView();
    } else if (action == KeyAction::fullScreen && !desk_.followsWindow) {
        answer(rank, kFixedSize);
        return;
    } else if (action == KeyAction::sceneTool) {
        depth_ = haptic_bridge::kUsualDepth;
    }
    try {
        for (const std::string& command : commandsOf(found, keyState(action == KeyAction::save))) {
            desk_.carryOut(command, rank);
        }
        answer(rank, answerOf(found, keyState(false)));
    } catch (const base::InputError& error) {
        answer(rank, error.what());
    }
}

KeyState WindowDesk::keyState(bool saves) {
    return {desk_.material,
            sceneMaterial_,
            toolLimits_,
            desk_.views.layers(),
            desk_.views.pattern(),
            desk_.paused,
            saves ? freeSaveName() : std::string()};
}

std::string WindowDesk::freeSaveName() {
    std::string name;
    do {
        name = fmt::format("save_{:03}", ++savesByKey_);
    } while (std::filesystem::exists(saveFile(out_, name)));
    return name;
}

void WindowDesk::moveView(std::span<haptic_bridge::PointerReport> pointers) {
    for (std::size_t rank = 0; rank < pointers.size(); ++rank) {
        haptic_bridge::PointerReport& pointer = pointers[rank];
        if (desk_.views.moves()) {
            if (!desk_.views.move(pointer)) {
                answer(static_cast<int>(rank), pointer.wheel > 0 ? kFarthest : kNearest);
            }
            continue;
        }
        pointer.depth += std::exchange(pointer.wheel, 0.0F);
        if (pointer.movesView()) {
            answer(static_cast<int>(rank), kFixedView);
        }
    }
}

void WindowDesk::turnWheels(std::span<const haptic_bridge::PointerReport> pointers) {
    for (std::size_t rank = 0; rank < pointers.size(); ++rank) {
        const haptic_bridge::PointerReport& pointer = pointers[rank];
        if (pointer.depth != 0) {
            depth_ = haptic_bridge::deepened(depth_, static_cast<double>(pointer.depth));
            answer(static_cast<int>(rank), depthInWords(depth_));
        }
        if (pointer.size != 0) {
            resizeTool(-static_cast<double>(pointer.size), static_cast<int>(rank));
        }
    }
}

void WindowDesk::resizeTool(double notches, int rank) {
    const double radius = toolLimits_.resized(desk_.material.toolRadius, notches);
    try {
        desk_.carryOut(fmt::format("tool radius={}", radius), rank);
        answer(rank, sizeInWords(keyState(false)));
    } catch (const base::InputError& error) {
        answer(rank, error.what());
    }
}

void WindowDesk::enlargeTool() {
    if (desk_.material.toolRadius < toolLimits_.usual) {
        try {
            desk_.carryOut(fmt::format("tool radius={}", toolLimits_.usual), 0);
        } catch (const base::InputError& error) {  // such as a full disk; the session continues
            host::printLine("the tool keeps the size of the scene: {}", error.what());
        }
    }
}

void WindowDesk::answer(int rank, const std::string& text) { answers_.show(rank, text, host::monotonicNs()); }

std::vector<lockstep::Answer> WindowDesk::answers(std::int64_t nowNs) {
    if (pointer_ && !std::exchange(hinted_, true) && !desk_.views.layers().shows(lockstep::Overlay::help)) {
        answers_.show(Answers::kLowestRow, lockstep::hint(), nowNs, Answers::kHintLife);
    }
    return answers_.at(nowNs);
}

}  // namespace master
