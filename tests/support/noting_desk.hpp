// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "master/operator/verbs.hpp"

namespace support {

/// A desk without a session. It notes what the last command has asked for.
struct NotingDesk {
    using Asker = master::Asker;

    void reportStatus(const Asker& /* asker */) { did = "status"; }
    void pause(bool paused) { did = paused ? "pause" : "resume"; }
    void askEdit(const sand::Edit& asked, const Asker& /* asker */) {
        did = "edit";
        edit = asked.kind;
    }
    void askReturn(sand::History::Move move, const Asker& /* asker */) {
        did = move == sand::History::Move::redo ? "redo" : "edit";  // an undo begins as the edit
        edit = sand::Edit::undo;
    }
    void showPattern(std::optional<lockstep::Pattern> shown) {
        did = "pattern";
        pattern = shown;
    }
    void showLayer(lockstep::Overlay which, bool shown) {
        did = shown ? "show" : "hide";
        layer = which;
    }
    void separateEyes(double metres) {
        did = "eye-separation";
        number = metres;
    }
    void showStereo(walls::Stereo mode) {
        did = "stereo";
        stereo = mode;
    }
    void swapEyes(bool swapped) { did = swapped ? "swap-eyes" : "swap-eyes back"; }
    void changeTool(const scene::ToolChange& change, const Asker& /* asker */) {
        did = "tool";
        tool = change;
    }
    void changeMaterial(const master::MaterialChange& change, const Asker& /* asker */) {
        did = "material";
        word = change.word;
        number = change.number;
    }
    void save(const std::string& name, const Asker& /* asker */) {
        did = "save";
        word = name;
    }
    void load(const std::string& name, const Asker& /* asker */) {
        did = "load";
        word = name;
    }
    void capture(const Asker& /* asker */) { did = "capture"; }
    void markFilm(const Asker& /* asker */) { did = "film"; }
    void shareForce(double share, const Asker& /* asker */) {
        did = "force";
        number = share;
    }
    void stop() { did = "stop"; }

    std::string did;
    sand::Edit::Kind edit{};
    std::optional<lockstep::Pattern> pattern;
    lockstep::Overlay layer{};
    walls::Stereo stereo{};
    scene::ToolChange tool;
    std::string word;
    double number = 0;
};

/// Returns what `command` asks of a desk.
inline NotingDesk noted(const std::string& command) {
    NotingDesk desk;
    master::carryOut(desk, command, {});
    return desk;
}

}  // namespace support
