// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "lockstep/arrival.hpp"
#include "lockstep/cluster.hpp"
#include "lockstep/frame_barrier.hpp"
#include "master/journal/saved_sand.hpp"
#include "master/operator/background_jobs.hpp"
#include "master/operator/captures.hpp"
#include "master/operator/film_marks.hpp"
#include "master/operator/operator_input.hpp"
#include "master/operator/undo_desk.hpp"
#include "master/operator/verb_arguments.hpp"
#include "master/operator/view_source.hpp"
#include "master/operator/window_desk.hpp"
#include "master/steps/edits.hpp"
#include "master/steps/master_sand.hpp"
#include "scene/model/scene.hpp"
#include "walls/wall.hpp"

namespace master {

struct DeskOptions {
    bool readInput = false;  // reads commands from standard input; its end stops the session
    lockstep::Pattern pattern = lockstep::Pattern::none;  // shown from the start
    lockstep::Overlays layers;                            // shown from the start
    tracking::Source tracker;                             // source of the head's pose
    std::optional<double> force;       // share of the force that an operator has set; nullopt: none has
    bool film = false;                 // the pictures have the size in the wall file
    bool pointer = false;              // the hand is the pointer, so that all keys of lockstep::keyList() act
    bool visibleTool = false;          // begins with WindowDesk::enlargeTool()
    std::optional<walls::Orbit> view;  // of a desktop from the start; nullopt: frames the terrain
};

/// Carries out and answers the commands that operators give a running session, on standard input or through its control
/// socket. Holds what the commands have changed: the view, the material, and whether the session is paused. Main thread
/// only.
class OperatorDesk {
public:
    /// The parts of a session that the desk uses.
    struct SessionParts {
        MasterSand& sand;
        Edits& edits;
        ForceControl* force;                     // null for a replay, whose only command is stop
        std::function<bool(std::int64_t)> room;  // whether the disk has room for so many bytes of loaded sand
        std::function<void(double)> keepForce;   // writes a share of the force to the journal
        std::function<nlohmann::json()> status;  // answer of `status`, without the fields of the desk
        bool keepsJournal = true;                // of which films are made
    };

    /// `material` is the material of the scene, or of the resumed session. The wall and the objects that `session`
    /// refers to must outlive the desk. Throws base::InputError if the tracker cannot be opened.
    OperatorDesk(const scene::Scene& scene, const scene::Material& material, const walls::Wall& wall,
                 std::filesystem::path out, const DeskOptions& options, SessionParts session);

    /// Carries out the commands since the last call, and the keys in `arrivals` that were pressed in the ranks'
    /// windows. Answers the askers of jobs that have ended.
    void obey(const std::vector<lockstep::Arrival>& arrivals);
    /// Returns what carries out the keys and wheels of the ranks' windows.
    [[nodiscard]] WindowDesk& windows() { return windows_; }
    [[nodiscard]] bool stopAsked() const { return input_.stopAsked(); }
    [[nodiscard]] bool paused() const { return paused_; }
    [[nodiscard]] ViewSource& views() { return views_; }
    /// Makes the picture follow its window, whose rank reports its size in `arrivals`. Ignored unless
    /// walls::followsWindow(), and for films.
    void followWindow(const std::vector<lockstep::Arrival>& arrivals);
    /// Returns the wall in the stereo mode that was chosen last, and in the size of its window.
    [[nodiscard]] const walls::Wall& shownWall() const { return shown_; }
    /// Returns whether pictures of the next frame are wanted.
    [[nodiscard]] bool needsCapture() const { return captures_.wanted(jobs_); }

    /// Answers all clients that wait for an edit that the edit waits for room on the disk. The haptic server may
    /// already have these edits, so they cannot be taken back. They are done when there is room.
    void answerEditsThatWaitForRoom();
    /// Answers the clients whose edits are in `steps`, which the wall shows now.
    void answer(const ArrivedSteps& steps);
    /// Calls Captures::take. A later obey() answers the askers.
    void takeCapture(std::uint64_t frame, lockstep::FrameBarrier& barrier);
    /// Waits for the background jobs, answers their askers, and removes the control socket.
    void close();

    // The rows of verbs.hpp call these functions. Each throws base::InputError if it refuses. A function with an
    // `asker` answers it, at once or later.
    void reportStatus(const Asker& asker);
    void pause(bool paused);
    /// Asks for an edit, after which the session has `material`.
    void askEdit(sand::Edit edit, const Asker& asker, const std::optional<scene::Material>& material = std::nullopt);
    /// Undoes the newest stroke or edit, or redoes the one that was undone last.
    void askReturn(sand::History::Move move, const Asker& asker);
    void showPattern(std::optional<lockstep::Pattern> pattern);  // nullopt: the next one
    void showLayer(lockstep::Overlay layer, bool shown) { views_.show(layer, shown); }
    void separateEyes(double metres) { views_.separateEyes(metres); }
    void showStereo(walls::Stereo stereo) { showWall(stereo, window_, shown_.swapEyes); }
    void swapEyes(bool swapEyes);
    void changeTool(const scene::ToolChange& change, const Asker& asker);
    void changeMaterial(const MaterialChange& change, const Asker& asker);
    void save(const std::string& name, const Asker& asker);
    void load(const std::string& name, const Asker& asker);
    void capture(const Asker& asker) { captures_.ask(asker); }
    /// Begins a film, or ends the one that has begun.
    void markFilm(const Asker& asker);
    void shareForce(double share, const Asker& asker);
    void stop() { input_.stop(); }

private:
    using Client = ControlSocket::Client;
    static constexpr std::int64_t kSettleNs = 60'000'000'000;  // [ns], longest wait of a client for the end of a settle
    /// Answers the client that waits for the end of a settle: how it ended, or that it continues.
    void answerSettle(std::optional<SettleEnd> end);

    void obeyLine(const std::string& line, const Asker& asker);
    std::uint64_t addEdit(sand::Edit edit, const Asker& asker, const std::optional<scene::Material>& material,
                          const sand::History::Intent& intent);
    /// Throws base::InputError if the disk has no room for `edit`.
    void requireRoomOnDisk(const sand::Edit& edit);
    std::uint64_t addReturn(sand::Edit edit, const scene::UndoHistory::Return& wanted, const Asker& asker);
    void answerReturn(const UndoDesk::Asked& asked, const ArrivedStep& shown);
    void askMaterial(const scene::Material& material, const Asker& asker);
    void showWall(walls::Stereo stereo, glm::ivec2 window, bool swapEyes);
    void finishJobs(bool wait);
    void answerAll(const Askers& askers, const BackgroundJobs::Result& result);
    void refuse(const std::string& why, const Askers& askers);
    [[nodiscard]] BackgroundJobs::Result endFilm();

    const walls::Wall& wall_;
    walls::Wall shown_;
    glm::ivec2 window_{0};  // [pixel], size of the window that the picture follows; 0: none, or not known yet
    const SandPlace place_;
    const scene::MaterialGrid grid_;
    scene::Material material_;  // with all changes that operators have asked for
    const std::filesystem::path out_;
    const SessionParts session_;
    ViewSource views_;
    OperatorInput input_;
    std::optional<ControlSocket> control_;  // nullopt for a replay
    BackgroundJobs jobs_;
    UndoDesk undo_;
    Captures captures_;
    FilmMarks films_;
    /// A settle that continues, and whose client waits for its end.
    struct Settling {
        Client client = 0;
        std::uint64_t step = 0;    // that began it
        std::int64_t sinceNs = 0;  // [ns]
    };
    std::optional<Settling> settling_;
    std::optional<double> force_;  // share of the force that an operator has set, 0 to 1, within any ceiling
    const bool film_;
    bool paused_ = false;
    WindowDesk windows_;
};

}  // namespace master
