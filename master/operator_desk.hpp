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
#include "lockstep/watchdog.hpp"
#include "master/captures.hpp"
#include "master/journal/saved_sand.hpp"
#include "master/master_sand.hpp"
#include "master/operator/background_jobs.hpp"
#include "master/operator/edit_queue.hpp"
#include "master/operator/operator_command.hpp"
#include "master/operator/operator_input.hpp"
#include "master/view_source.hpp"
#include "scene/scene.hpp"
#include "walls/wall.hpp"

namespace master {

struct DeskOptions {
    bool readInput = false;  // lines on standard input are obeyed, and its end ends the session
    lockstep::Pattern pattern = lockstep::Pattern::none;  // shown from the start
    lockstep::Overlays layers;                            // as well
    tracking::Source tracker;                             // where the head's pose comes from
};

/// Obeys what people ask of a running session, typed or through its control socket, and answers them; holds what they
/// have changed: the views, the material, and whether sand stands still. Main thread only.
class OperatorDesk {
public:
    /// The parts of a session that the desk uses.
    struct Session {
        const MasterSand& sand;
        StepRequests* requests;                  // null for a replay: nobody commands that but to stop
        std::function<bool(std::int64_t)> room;  // whether the disk has room for so many bytes of loaded sand
        std::function<nlohmann::json()> status;  // that `status` answers, but for what the desk knows
    };

    /// `material` is that of the scene, or of the session that goes on. The wall and what `session` refers to outlive
    /// the desk. Throws base::InputError when the tracker cannot be had.
    OperatorDesk(const scene::Scene& scene, const scene::Material& material, const walls::Wall& wall,
                 std::filesystem::path out, const DeskOptions& options, Session session);

    /// Obeys all that has come since the last call, and the keys that were pressed in the ranks' windows. Answers what
    /// threads have finished.
    void obey(const std::vector<lockstep::Arrival>& arrivals);
    [[nodiscard]] bool stopAsked() const { return input_.stopAsked(); }
    [[nodiscard]] bool paused() const { return paused_; }
    [[nodiscard]] const EditQueue& edits() const { return edits_; }
    [[nodiscard]] ViewSource& views() { return views_; }
    /// The wall in the stereo mode that was chosen last.
    [[nodiscard]] const walls::Wall& shownWall() const { return shown_; }
    /// Whether pictures of the next frame are wanted.
    [[nodiscard]] bool wantsCapture() const { return captures_.wanted(jobs_); }

    /// Tells all who wait for an edit that it waits for room on the disk. A server may have their edits already, so
    /// that they cannot be taken back: they are done when there is room.
    void tellWhoWaitsForRoom();
    /// Answers those whose edits are in `steps`, which the wall shows now.
    void answer(const std::vector<haptic_bridge::TimedStep>& steps);
    /// Calls Captures::take. A later obey() answers the clients.
    void takeCapture(std::uint64_t frame, const lockstep::Cluster& cluster, lockstep::Watchdog& watchdog);
    /// Waits for the threads, answers their clients, and removes the control socket.
    void close();

private:
    using Client = ControlSocket::Client;

    void obeyLine(const std::string& line, std::optional<Client> client);
    /// Returns whether the command is done, so that its client is told.
    [[nodiscard]] bool carryOut(const Command& command, std::optional<Client> client);
    void askEdit(sand::Edit edit, std::optional<Client> client,
                 const std::optional<scene::Material>& material = std::nullopt);
    void askMaterial(const scene::Material& material, std::optional<Client> client);
    void changeStereo(walls::Stereo stereo);
    void save(const std::string& name, std::optional<Client> client);
    void load(const std::string& name, std::optional<Client> client);
    void finishJobs(bool wait);
    [[nodiscard]] std::string status() const;
    void answerClient(std::optional<Client> client, const std::string& json);
    void answerAll(const Clients& clients, const std::string& json);
    void refuse(const std::string& why, const Clients& clients);

    const walls::Wall& wall_;
    walls::Wall shown_;
    const SandPlace place_;
    const scene::MaterialGrid grid_;
    scene::Material material_;  // with all that was asked for
    const std::filesystem::path out_;
    const Session session_;
    ViewSource views_;
    OperatorInput input_;
    std::optional<ControlSocket> control_;  // none for a replay
    EditQueue edits_;
    BackgroundJobs jobs_;
    Captures captures_;
    bool paused_ = false;
};

}  // namespace master
