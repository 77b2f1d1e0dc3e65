// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "haptic_bridge/hand/pointer.hpp"
#include "lockstep/key_list.hpp"
#include "master/operator/answers.hpp"
#include "master/operator/key_commands.hpp"
#include "master/operator/view_source.hpp"
#include "scene/model/scene.hpp"

namespace master {

/// Carries out the keys and wheels of the ranks' windows, moves the view, and answers in the windows. Main thread only.
class WindowDesk {
public:
    /// The parts of the operator's desk that the windows use.
    struct Desk {
        ViewSource& views;
        const scene::Material& material;  // with all changes that operators have asked for
        const bool& paused;
        bool followsWindow;                         // walls::followsWindow()
        std::function<sand::HeightSpan()> heights;  // of the sand
        /// Carries out a command for a rank's window. Throws base::InputError if the command is refused.
        std::function<void(const std::string& command, int rank)> carryOut;
    };

    /// `pointer`: all keys of lockstep::keyList() act, because the hand is the pointer. `out` is the folder of the
    /// session. The objects that `desk` refers to must outlive this one.
    WindowDesk(const scene::Scene& scene, std::filesystem::path out, bool pointer, Desk desk);

    /// Carries out a key that was pressed in a window of `rank` at `nowNs`.
    void obey(base::Keystroke key, int rank, std::int64_t nowNs);
    /// Moves the view as the pointers in the ranks' windows have dragged it, and zooms by their wheels. If the view is
    /// fixed, the wheels count as PointerReport::depth instead. An attempt to move a fixed view is answered in its
    /// window.
    void moveView(std::span<haptic_bridge::PointerReport> pointers);
    /// Changes depth and size of the tool as the wheels have turned. Call it after moveView().
    void turnWheels(std::span<const haptic_bridge::PointerReport> pointers);
    /// Frames the terrain, if people may move the view.
    void frameView();
    /// Gives the tool its usual size by an edit, if that of the scene is smaller.
    void enlargeTool();
    /// Returns the depth of the pointer's tool [tool radius].
    [[nodiscard]] double depth() const { return depth_; }
    /// Shows an answer in the windows of a rank.
    void answer(int rank, const std::string& text);
    /// Returns the answers that the windows show at `nowNs`. The first call of a session with a pointer begins the
    /// hint.
    [[nodiscard]] std::vector<lockstep::Answer> answers(std::int64_t nowNs);

private:
    /// Carries out a key that has an entry.
    void obey(const lockstep::KeyFound& found, int rank);
    /// Closes the help. If it is closed, asks, and ends the session if a person asks again.
    void leave(const lockstep::KeyFound& found, int rank, std::int64_t nowNs);
    void resizeTool(double notches, int rank);
    /// Returns the state from which a key starts, with a name for a file if it `saves`.
    [[nodiscard]] KeyState keyState(bool saves);
    /// Returns a name that no file has, and that no earlier key has got: a thread may still be writing those files.
    [[nodiscard]] std::string freeSaveName();

    const Desk desk_;
    const scene::Material sceneMaterial_;  // as the scene file has it
    const haptic_bridge::ToolLimits toolLimits_;
    const std::filesystem::path out_;
    const bool pointer_;
    Answers answers_;
    bool hinted_ = false;                        // whether the hint was shown
    double depth_ = haptic_bridge::kUsualDepth;  // of the pointer's tool [tool radius]
    std::optional<std::int64_t> askedNs_;        // when a person was last asked whether the session ends
    int savesByKey_ = 0;                         // number of the last file that a key has asked for
};

}  // namespace master
