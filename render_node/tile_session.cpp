// SPDX-License-Identifier: Apache-2.0
#include "render_node/tile_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "base/float_environment.hpp"
#include "base/not_yet_error.hpp"
#include "host/build_id.hpp"
#include "host/clock.hpp"
#include "host/memory.hpp"
#include "host/print_line.hpp"
#include "lockstep/clock_sync.hpp"
#include "lockstep/divergence.hpp"
#include "lockstep/frame_barrier.hpp"
#include "lockstep/frame_message.hpp"
#include "lockstep/healing.hpp"
#include "lockstep/sand_time.hpp"
#include "lockstep/screenshots.hpp"
#include "lockstep/session_message.hpp"
#include "lockstep/statistics.hpp"
#include "lockstep/view_agreement.hpp"
#include "lockstep/watchdog.hpp"
#include "render_node/gl/gl_program.hpp"
#include "render_node/pointer/next_key.hpp"
#include "render_node/pointer/pointer_reader.hpp"
#include "render_node/tile_painter.hpp"
#include "scene/model/scene.hpp"
#include "scene/model/session_memory.hpp"
#include "walls/stereo_change.hpp"
#include "walls/window_size.hpp"

namespace render_node {
namespace {

using host::monotonicNs;

// Parts of the work before a rank is ready, at their ends. A session that is not resumed has no state.
constexpr double kContextMade = 0.1, kSceneDecoded = 0.4, kReplicaMade = 0.5, kPainterMade = 0.6, kStateDecoded = 1;

/// Returns a function that takes numbers of bytes, `all` of them together, and tells the master the progress from part
/// `from` to part `to` of the work.
std::function<void(std::size_t)> told(const lockstep::Cluster& cluster, double from, double to, std::size_t all) {
    return [&cluster, from, to, all = static_cast<double>(all), done = 0.0](std::size_t bytes) mutable {
        done += static_cast<double>(bytes);
        cluster.rankProgress(from + (to - from) * std::min(1.0, done / all));
    };
}

/// Session of one tile: its replica, its context and its painter.
class TileSession {
public:
    TileSession(const lockstep::Cluster& cluster, const lockstep::SessionMessage& message, Backend backend,
                const base::Executor* executor)
        : cluster_(cluster),
          message_(message),
          faults_(message.faults, cluster.rank()),
          wall_(walls::Wall::decode(message.wall)),
          shown_(wall_),
          tile_(wall_.tiles.at(static_cast<std::size_t>(cluster.rank() - 1))),
          viewProof_(wall_.encode()),
          context_(makeContext(backend, wall_, tile_, message.pointer, message.sceneName)),
          otherFloats_(base::repairFloats()),
          pointer_(shown_, cluster.rank()) {
        if (faults_.spoilsShader()) {
            const GlProgram broken(shaderSource("solid.vert.glsl"), shaderSource("light.glsl"),
                                   {"sand.frag.glsl", "spoilt on purpose"});
        }
        requireMemory();
        cluster.rankProgress(kContextMade);
        scene::Scene scene = scene::Scene::decode(message.scene, scene::Scene::Keep::packedToo,
                                                  told(cluster, kContextMade, kSceneDecoded, message.scene.size()));
        replica_ = sand::Replica::takingHeightsOf(scene, executor);
        cluster.rankProgress(kReplicaMade);
        painter_.emplace(shown_, shown_.tiles.at(static_cast<std::size_t>(cluster.rank() - 1)), scene,
                         lockstep::hostName(), replica_->surface().data());
        cluster.rankProgress(kPainterMade);
    }

    /// Takes the sand of a resumed session. The painter's box stays that of the scene's start.
    void resume(const base::Bytes& state) {
        replica_->decodeStateInPlace(state, told(cluster_, kPainterMade, kStateDecoded, state.size()));
    }

    [[nodiscard]] const GlContext& context() const { return *context_; }
    /// Returns Readiness::otherFloats.
    [[nodiscard]] const std::string& otherFloats() const { return otherFloats_; }
    /// Returns the rank's name as the master prints it.
    [[nodiscard]] std::string name() const { return fmt::format("rank {} (tile {})", tile_.rank, tile_.name); }
    [[nodiscard]] const std::string& tile() const { return tile_.name; }

    /// Runs frames until the session ends or the ranks disagree.
    void run() {
        const std::int64_t clockAhead = lockstep::clockAheadOfMaster(cluster_);
        lockstep::FrameBarrier barrier(cluster_, {}, message_.frameTimeout);
        if (message_.pointer) {
            barrier.carryPointers();
        }
        std::int64_t lastSwap = 0;
        TileFigures figures;  // of the previous frame
        for (bool more = true; more;) {
            std::size_t bytes = 0;
            watchWindows(barrier.quietUntil());
            lockstep::FrameMessage frame = barrier.begin({}, bytes);
            barrier.watchdog().setLimit(message_.frameTimeout);  // longer after pictures
            applyFaults(frame);
            applySteps(frame);
            changeWall(frame.view);
            const std::int64_t start = monotonicNs();
            figures.wall = std::move(frame.figures).value_or(lockstep::WallFigures{});
            draw(frame, figures);
            faults_.delay(frame.frame);
            const std::int64_t drawn = monotonicNs();
            figures.drawMs = static_cast<double>(drawn - start) * 1e-6;
            drawMs_.add(figures.drawMs);
            const std::uint64_t hash = replica_->stateHash();
            const std::int64_t arrived = monotonicNs();
            cost_.hashNs += arrived - drawn;
            if (message_.pointer) {
                barrier.setPointer(readPointer(frame.view, clockAhead));
            }
            if (faults_.garbles(frame.frame)) {
                barrier.garble();
            }
            const glm::ivec2 window = context_->windows().followedSize(0);
            lockstep::Arrival mine{frame.frame,
                                   arrived - clockAhead,
                                   lastSwap,
                                   drawn - start,
                                   hash,
                                   replica_->movementDigest(),
                                   viewProof_.hash(frame.view),
                                   nextKey(),
                                   cost_.dragNs,
                                   cost_.phaseNs,
                                   cost_.sweepNs,
                                   cost_.hashNs,
                                   {window.x, window.y}};
            const std::vector<base::MonitorState> monitors = context_->windows().monitorStates();
            for (std::size_t i = 0; i < std::min(monitors.size(), mine.monitors.size()); ++i) {
                mine.monitors.at(i) = static_cast<std::uint8_t>(monitors[i]);
            }
            if (!agree(barrier, mine, frame, figures)) {
                (void)lockstep::gatherReports(barrier, report());
                return;
            }
            // All ranks have agreed here. Off screen, swap() only ends the frame.
            context_->swap();
            lastSwap = monotonicNs() - clockAhead;
            figures.waitMs = static_cast<double>(monotonicNs() - arrived) * 1e-6;
            waitMs_.add(figures.waitMs);
            more = !frame.stop;
            if (frame.stop) {
                (void)lockstep::gatherReports(barrier, report());
            }
            if (frame.capture) {
                sendPictures(barrier, frame.stop);
            }
        }
    }

private:
    /// Throws base::InputError if this process may not take the memory for the sand, such as under a limit of its
    /// address space (ulimit -v). Called before the sand is made.
    void requireMemory() const {
        const sand::Rules rules = scene::Scene::decodeRules(message_.scene);
        const scene::SandSize sand{sand::FieldSize::of(rules), rules.ground != 0};
        const std::int64_t needed =
            scene::ProcessMemory::ofRank(sand, walls::frameBufferBytes(wall_, tile_)).figures().most();
        scene::requireProcess(needed, host::freeMemoryOfProcess(), message_.sceneName,
                              {sand.field.text(), "fewer cells"}, fmt::format("rank of {}", lockstep::hostName()));
    }

    void applyFaults(lockstep::FrameMessage& frame) {
        faults_.strike(frame.frame, *replica_);
        if (faults_.movesView(frame.frame)) {
            frame.view.head[0] += 1;
        }
    }

    /// Lets the pointer's events come in until `until` [ns], when the next frame begins at the earliest. So each event
    /// gets its own time. All other sessions sleep in FrameBarrier::begin().
    void watchWindows(std::int64_t until) {
        if (!message_.pointer) {
            return;
        }
        for (std::int64_t left = until - monotonicNs(); left > 0; left = until - monotonicNs()) {
            context_->windows().awaitEvents(static_cast<double>(left) * 1e-9);
        }
    }

    [[nodiscard]] haptic_bridge::PointerReport readPointer(const lockstep::ViewState& view, std::int64_t clockAhead) {
        return pointer_.read(context_->windows().takePointer(), *replica_, view, painter_->heightsEver(), clockAhead);
    }

    /// Draws a frame from the current sand and presents it.
    void draw(const lockstep::FrameMessage& frame, const TileFigures& figures) {
        // showsEyesInTurn() describes the previous frame, which may have had another stereo mode.
        const bool inTurn = context_->showsEyesInTurn() && shown_.stereo == walls::Stereo::active;
        painter_->setSharp(frame.sharp);
        painter_->paint(*replica_, frame.view, frame.frame, inTurn && !frame.capture, figures, frame.answers);
        context_->present(painter_->outputs(), painter_->changed(), frame.frame);
    }

    /// Meets the other ranks at the barrier. If replicas differ, heals the sand, draws again and meets the ranks again.
    /// Returns false if the session ends; the master then prints the reason and ends with a status for it.
    bool agree(lockstep::FrameBarrier& barrier, lockstep::Arrival mine, const lockstep::FrameMessage& frame,
               const TileFigures& figures) {
        lockstep::Verdict verdict = barrier.meet(mine);
        while (verdict == lockstep::Verdict::otherSand) {
            (void)lockstep::findDivergence(barrier, *replica_);
            const lockstep::Healing healing = lockstep::heal(barrier, *replica_);
            if (healing == lockstep::Healing::ended) {
                return false;
            }
            if (healing == lockstep::Healing::healed) {
                painter_->drawAgain();
                draw(frame, figures);
            }
            mine.stateHash = replica_->stateHash();
            mine.movement = replica_->movementDigest();
            verdict = barrier.meet(mine);
        }
        return verdict == lockstep::Verdict::equal;
    }

    /// Changes the stereo mode and the order of the eyes to the operator's choice, and the picture to the size of its
    /// window. The master has checked that the outputs can show the mode.
    void changeWall(const lockstep::ViewState& view) {
        const auto stereo = static_cast<walls::Stereo>(view.stereo);
        const glm::ivec2 window(view.window[0], view.window[1]);
        if (stereo != shown_.stereo || window != window_ || view.swapEyes != shown_.swapEyes) {
            window_ = window;
            shown_ = walls::withSwappedEyes(walls::shownInWindow(walls::shownOnItsOutputs(wall_, stereo), window),
                                            view.swapEyes);
            painter_->showAs(shown_, shown_.tiles.at(static_cast<std::size_t>(cluster_.rank() - 1)));
        }
    }

    void applySteps(const lockstep::FrameMessage& frame) {
        cost_ = {};
        for (const sand::Step& step : frame.steps) {
            cost_ += lockstep::applyTimed(*replica_, step);
        }
        const std::int64_t applied = monotonicNs();
        replica_->audit(static_cast<int>(frame.auditTiles));
        cost_.hashNs = monotonicNs() - applied;
    }

    /// Returns the next key that was pressed in a window. The other keys wait for the next frames.
    [[nodiscard]] base::Keystroke nextKey() {
        const std::vector<base::Keystroke> pressed = context_->windows().takeKeys();
        keys_.insert(keys_.end(), pressed.begin(), pressed.end());
        return takeNextKey(keys_);
    }

    /// The master may take the limit of a frame for each picture of each rank. So a rank may wait longer until all have
    /// been received. It waits for the master to take its pictures, and then for the next frame or the session's end.
    void sendPictures(lockstep::FrameBarrier& barrier, bool last) const {
        const auto pictures = static_cast<double>(painter_->pictures().size());
        const double limit = message_.frameTimeout * (1 + pictures * cluster_.renderRanks());  // [s]
        barrier.watchdog().setLimit(limit);
        if (last) {
            barrier.setEndLimit(limit);
        }
        const lockstep::Watched watched(barrier.watchdog());
        int eye = 0;
        for (const EyeTarget* target : painter_->pictures()) {
            lockstep::sendPicture(cluster_,
                                  {cluster_.rank(), eye++, target->width(), target->height(), target->read()});
        }
    }

    [[nodiscard]] lockstep::RankReport report() const {
        const ViewCounts& views = painter_->viewCounts();
        const double share =
            views.pixels == 0 ? 0 : static_cast<double>(views.pixelsDrawn) / static_cast<double>(views.pixels);
        return {lockstep::hostName(),
                context_->renderer(),
                context_->windows().swapLock(),
                drawMs_.percentile(0.5),
                drawMs_.percentile(0.99),
                drawMs_.largest(),
                waitMs_.percentile(0.5),
                waitMs_.percentile(0.99),
                lockstep::residentBytes(),
                painter_->frameBufferBytes() + context_->frameBufferBytes(),
                views.skipped,
                views.inPart,
                views.whole,
                share};
    }

    const lockstep::Cluster& cluster_;
    const lockstep::SessionMessage& message_;
    lockstep::FaultsOfRank faults_;
    lockstep::SandTime cost_;  // of the frame
    walls::Wall wall_;         // at the start of the session
    walls::Wall shown_;        // in the mode and the size of the last frame; the painter refers to it
    glm::ivec2 window_{0};     // [pixel], lockstep::ViewState::window of the last frame
    const walls::Tile& tile_;
    lockstep::ViewProof viewProof_;
    std::unique_ptr<GlContext> context_;  // declared before all owners of GL objects
    const std::string otherFloats_;
    std::optional<sand::Replica> replica_;
    std::optional<TilePainter> painter_;
    PointerReader pointer_;
    std::vector<base::Keystroke> keys_;  // pressed keys that no arrival has carried yet
    lockstep::Statistics drawMs_, waitMs_;
};

}  // namespace

int showTile(const lockstep::Cluster& cluster, Backend backend, const base::Executor* executor) {
    std::optional<lockstep::SessionMessage> message = lockstep::broadcastSession(cluster, nullptr);
    if (!message) {
        return 0;  // the master has printed the reason
    }
    lockstep::Readiness readiness{lockstep::hostName(), host::buildId(), "", "", {}, 0};
    std::unique_ptr<TileSession> session;
    const auto orRefuse = [&readiness](const auto& work) {
        try {
            work();
        } catch (const std::exception& error) {
            readiness.error = error.what();
            readiness.mayStillCome = dynamic_cast<const base::NotYetError*>(&error) != nullptr;
        }
    };
    orRefuse([&] {
        lockstep::requireStartUpLimit();
        session = std::make_unique<TileSession>(cluster, *message, backend, executor);
        readiness.tile = session->tile();
        readiness.otherFloats = session->otherFloats();
        readiness.renderer = session->context().renderer();
        readiness.shortcomings = session->context().windows().shortcomings();
        readiness.framesToIgnore = static_cast<std::uint32_t>(session->context().windows().framesToIgnore());
    });
    message->scene = base::Bytes();  // the session has the sand in its replica
    if (message->resumes) {
        const base::Bytes state = lockstep::broadcastState(cluster, {});
        if (readiness.error.empty() && !state.empty()) {  // the master refuses the session if it is empty
            orRefuse([&] { session->resume(state); });
        }
    }
    cluster.rankProgress(kStateDecoded);
    (void)lockstep::gatherReadiness(cluster, readiness);
    if (!lockstep::agreeToGoOn(cluster, false)) {
        return 0;
    }
    try {
        session->run();
    } catch (const std::exception& error) {
        // The other ranks are in the middle of a frame and cannot be asked to end.
        host::printLine("{} on {}: {}", session->name(), readiness.host, error.what());
        cluster.abort(1);
    }
    return 0;
}

}  // namespace render_node
