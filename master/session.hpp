// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <future>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "lockstep/divergence.hpp"
#include "lockstep/frame_barrier.hpp"
#include "lockstep/frame_message.hpp"
#include "lockstep/rank_statistics.hpp"
#include "lockstep/view_agreement.hpp"
#include "master/drills.hpp"
#include "master/failure_report.hpp"
#include "master/film.hpp"
#include "master/frame_clock.hpp"
#include "master/incidents.hpp"
#include "master/journal/keeper.hpp"
#include "master/journal/recording.hpp"
#include "master/journal/resume.hpp"
#include "master/journal/saved_sand.hpp"
#include "master/operator/control_socket.hpp"
#include "master/operator/operator_command.hpp"
#include "master/operator/operator_input.hpp"
#include "master/recovery.hpp"
#include "master/steps/live_steps.hpp"
#include "master/summary.hpp"
#include "master/view_source.hpp"
#include "sand/replica.hpp"
#include "scene/scene.hpp"
#include "walls/wall.hpp"

namespace master {

inline constexpr std::uint64_t kNoLimit = std::numeric_limits<std::uint64_t>::max();

/// How a session runs.
struct SessionOptions {
    std::optional<haptic_bridge::Address> server;
    haptic_bridge::LinkSecurity security;  // of the link with it
    Pace pace = Pace::realtime;
    std::optional<double> refreshHz;   // frames per second; none: the wall file's
    std::uint64_t steps = kNoLimit;    // ends when exactly this many have been shown
    std::uint64_t frames = kNoLimit;   // ends after this many
    std::uint64_t settlingFrames = 0;  // from the start, whose times do not count
    double frameTimeout = 30;          // [s] that a frame may take before the job ends
    bool pictures = true;
    lockstep::Pattern pattern = lockstep::Pattern::none;  // shown from the start
    lockstep::Overlays layers;                            // as well
    tracking::Source tracker;                             // where the head's pose comes from
    bool readInput = false;                               // "stop" on standard input, or its end, ends the session
    std::filesystem::path out;
    JournalOptions journal;
    sand::grid::Erosion::Options sweeps;            // how the master's own replica is swept
    std::shared_ptr<const Recording> recording;     // steps come from there, and no journal is written
    std::shared_ptr<const ResumedSession> resumed;  // goes on where that one stopped
    Failure failure;                                // that made it stop
    bool film = false;                              // every frame becomes a picture, and there are no others
    std::optional<FilmEye> filmEye;
    std::vector<Drill> drills;  // still to happen
};

/// The frame loop of the master: number, broadcast, journal, apply, agree, swap; 60 times a second if the wall can.
class Session {
public:
    Session(const lockstep::Cluster& cluster, const scene::Scene& scene, const walls::Wall& wall,
            SessionOptions options);

    /// Runs to the end and writes journal, pictures and summary. Returns the exit status: 0, or 1 when replicas
    /// differed, or a replica and the recording. Collective with renderTile() of the render ranks.
    int run();

private:
    [[nodiscard]] lockstep::FrameMessage prepare(std::vector<haptic_bridge::TimedStep>& steps);
    [[nodiscard]] std::int64_t nextFrame() const;  // [ns], at the earliest
    void waitForFrameTime();
    void obeyOperator();
    void obey(const std::string& line, std::optional<ControlSocket::Client> client);
    void carryOut(const Command& command, std::optional<ControlSocket::Client> client);
    void askEdit(sand::Edit edit, std::optional<ControlSocket::Client> client,
                 const std::optional<scene::Material>& material = std::nullopt);
    /// Only a material that is in a step's queue becomes the one that the next is made from.
    void askMaterial(const scene::Material& material, std::optional<ControlSocket::Client> client);
    void changeStereo(walls::Stereo stereo);
    /// Who asked; nothing stands for somebody who typed it.
    using Clients = std::vector<std::optional<ControlSocket::Client>>;
    void refuse(const std::string& why, const Clients& clients);
    void answerAll(const Clients& clients, const std::string& json);
    /// What a thread beside the frames has done: a line of JSON, or an edit that is still to be asked for.
    struct ErrandDone {
        std::string json;
        sand::Edit edit;
    };
    void startErrand(std::function<ErrandDone()> work, Clients clients, bool capture = false);
    void requireFewErrands() const;
    [[nodiscard]] bool capturing() const;
    void save(const std::string& name, std::optional<ControlSocket::Client> client);
    void load(const std::string& name, std::optional<ControlSocket::Client> client);
    /// Answers who asked for what is done; with `wait` for all that is not, too.
    void finishErrands(bool wait);
    void answer(std::optional<ControlSocket::Client> client, const std::string& json);
    void answerEdits(const std::vector<haptic_bridge::TimedStep>& steps);
    void takeCapture();
    [[nodiscard]] std::string status() const;
    [[nodiscard]] double sessionTime() const;  // [s]
    [[nodiscard]] std::vector<haptic_bridge::TimedStep> awaitSteps();
    [[nodiscard]] bool showFrame();
    void keepJournal(const JournalFrame& frame);
    void keepTicks();
    void endJournal(bool agreed);
    void beginJournal(const scene::Scene& scene);
    /// Whether the disk has room for the steps of the next frame, with one more edit.
    [[nodiscard]] bool mayTakeSteps(const sand::Edit& more = {});
    /// A server may have their edits already, so that they cannot be taken back: they are done when there is room.
    void tellWhoWaitsForRoom();
    /// Leaves word for whoever supervises, and returns with nothing shown: the job ends.
    [[noreturn]] void endForDisk(const DiskFailure& failure);
    void tellRecovery();
    void applySteps(const std::vector<haptic_bridge::TimedStep>& steps);
    void compareWithRecording();
    [[nodiscard]] lockstep::WallFigures wallFigures() const;
    [[nodiscard]] Incidents incidents() const;  // since the session's beginning
    void measureSwaps(std::int64_t now);
    void measureLatency(const std::vector<haptic_bridge::TimedStep>& steps, std::int64_t broadcast,
                        std::int64_t swapped);
    [[nodiscard]] const char* handInWords() const;
    void sayProgress(bool last);
    /// Until all agree; false when the session has to end, which has then been said.
    bool reachAgreement(lockstep::Verdict verdict, lockstep::Arrival mine);
    bool healSand(bool again);
    [[nodiscard]] std::filesystem::path writtenJournal() const;  // empty when there is none
    [[nodiscard]] std::unique_ptr<sand::Replica> sandOfJournal();
    [[nodiscard]] std::optional<int> brokenAmong(const std::vector<int>& odd) const;
    [[nodiscard]] std::string giveUp(int rank, bool again);
    void reportOtherViews();
    void reportNonsense();
    [[nodiscard]] FailureReport failureOf(const std::string& what, int rank, const std::string& line) const;
    void startDrills();
    void finish(bool agreed);

    const lockstep::Cluster& cluster_;
    const walls::Wall& wall_;
    walls::Wall shown_;  // in the stereo mode that the operator has chosen
    const SandPlace place_;
    const scene::MaterialGrid grid_;
    scene::Material material_;  // with all that the operator has asked for
    SessionOptions options_;
    sand::Replica terrain_;
    std::vector<std::string> names_;  // of ranks, as messages speak of them
    lockstep::FrameBarrier barrier_;
    FrameClock clock_;
    ViewSource views_;
    lockstep::ViewProof viewProof_;
    std::optional<JournalKeeper> journal_;  // none for a recording, which has one
    std::optional<Film> film_;
    LiveSteps liveSteps_;
    OperatorInput operator_;
    std::optional<ControlSocket> control_;
    struct Asker {
        sand::Edit edit;
        std::optional<ControlSocket::Client> client;  // none: typed, or answered already
        std::optional<scene::Material> material;      // that the edit makes the session's
    };
    struct Errand {
        std::future<ErrandDone> work;
        Clients clients;
        bool capture = false;
    };
    std::vector<Errand> errands_;
    std::deque<Asker> askers_;             // whose edits are in no step yet
    Clients captures_;                     // who wants pictures of the next frame
    bool paused_ = false;                  // no steps are taken
    bool standing_ = false;                // likewise, for want of room on the disk
    double fps_ = 0;                       // over the last second or so
    const lockstep::FaultsOfRank faults_;  // of the master itself
    Summary summary_;
    lockstep::RankStatistics rankStatistics_;
    IncidentFile incidentFile_;
    double lastFrameMs_ = 0;
    std::uint64_t frame_ = 0;
    std::uint64_t hash_ = 0;                     // of the state the wall shows
    std::int64_t firstSwap_ = 0, lastSwap_ = 0;  // [ns]
    std::int64_t lastProgress_ = 0;              // [ns]
    std::uint64_t lastProgressFrame_ = 0;
    double lastSkewUs_ = 0;
    bool stopping_ = false;
    bool strayed_ = false;   // from the recording
    std::string strayLine_;  // how, while it may still be the master's own memory that strayed
};

}  // namespace master
