// SPDX-License-Identifier: Apache-2.0
#include "render_node/tile_session.hpp"

#include <memory>
#include <optional>
#include <vector>

#include "lockstep/build_id.hpp"
#include "lockstep/clock_sync.hpp"
#include "lockstep/divergence.hpp"
#include "lockstep/frame_barrier.hpp"
#include "lockstep/frame_message.hpp"
#include "lockstep/screenshots.hpp"
#include "lockstep/session_message.hpp"
#include "lockstep/statistics.hpp"
#include "render_node/eye_target.hpp"
#include "render_node/sand_view.hpp"
#include "walls/projection.hpp"

namespace render_node {
namespace {

using lockstep::nowNs;

/// One tile: its replica, its context and what it draws into.
class TileSession {
public:
    TileSession(const lockstep::Cluster& cluster, const lockstep::SessionMessage& message, Backend backend,
                const sand::Erosion::Options& sweeps)
        : cluster_(cluster),
          fault_(message.fault),
          wall_(walls::Wall::decode(message.wall)),
          tile_(wall_.tiles.at(static_cast<std::size_t>(cluster.rank() - 1))),
          context_(makeContext(backend, wall_, tile_)) {
        const sand::Scene scene = sand::Scene::decode(message.scene);
        terrain_.emplace(scene, sweeps);
        const sand::HeightField& field = scene.terrain;
        view_.emplace(
            scene, walls::stageToRoom(wall_.stage, field.columns() * field.cellSize(), field.rows() * field.cellSize(),
                                      scene.referenceHeight() * field.unit()));
        for (std::size_t i = 0; i < walls::eyesOf(wall_.stereo).size(); ++i) {
            targets_.emplace_back(tile_.pixels.x, tile_.pixels.y);
        }
        memories_.resize(targets_.size());
        for (const EyeTarget& target : targets_) {
            constexpr int kBytesPerPixel = 8;  // colour and depth
            frameBufferBytes_ += std::int64_t{kBytesPerPixel} * target.width() * target.height();
        }
    }

    /// Frames until the last one, or until replicas differ.
    void run(double frameTimeout) {
        const std::int64_t clockAhead = lockstep::clockAheadOfMaster(cluster_);
        lockstep::FrameBarrier barrier(cluster_, {}, frameTimeout);
        std::int64_t lastSwap = 0;
        for (bool more = true; more;) {
            std::size_t bytes = 0;
            const lockstep::FrameMessage frame = barrier.begin({}, bytes);
            apply(frame);
            const std::int64_t start = nowNs();
            draw(frame.view);
            const std::int64_t drawn = nowNs();
            drawMs_.add(static_cast<double>(drawn - start) * 1e-6);
            const std::uint64_t hash = terrain_->stateHash();
            const std::int64_t arrived = nowNs();
            const bool equal = barrier.meet({frame.frame, arrived - clockAhead, lastSwap, drawn - start, hash});
            // Nobody comes here before all have agreed. Off screen, to swap is to let the pictures count.
            lastSwap = nowNs() - clockAhead;
            waitMs_.add(static_cast<double>(nowNs() - arrived) * 1e-6);
            if (!equal) {
                (void)lockstep::findDivergence(cluster_, *terrain_);
                (void)lockstep::gatherReports(cluster_, report());
                return;  // the master says what differs, and ends with the status for it
            }
            more = !frame.stop;
            if (frame.stop) {
                (void)lockstep::gatherReports(cluster_, report());
            }
            if (frame.capture) {
                sendPictures();
            }
        }
    }

private:
    void apply(const lockstep::FrameMessage& frame) {
        if (fault_ && fault_->rank == cluster_.rank() && fault_->frame == frame.frame) {
            terrain_->corrupt(fault_->column, fault_->row);
        }
        for (const sand::Step& step : frame.steps) {
            terrain_->apply(step);
        }
        terrain_->audit(static_cast<int>(frame.auditTiles));
    }

    void draw(const lockstep::ViewState& state) {
        view_->update(terrain_->field(), terrain_->takeDamage());
        if (terrain_->stepNumber() > 0) {
            view_->setTool(terrain_->probe(), terrain_->engaged());
        }
        walls::Viewer viewer = wall_.viewer;
        viewer.eye = {state.head[0], state.head[1], state.head[2]};
        viewer.right = {state.right[0], state.right[1], state.right[2]};
        viewer.eyeSeparation = state.eyeSeparation;
        std::size_t next = 0;
        for (const walls::Eye eye : walls::eyesOf(wall_.stereo)) {
            const glm::dvec3 position = walls::eyePosition(viewer, eye);
            const walls::View view = walls::viewOf(tile_.screen, position, wall_.clip.near, wall_.clip.far);
            view_->drawIfChanged({view.viewProjection, position}, targets_[next], memories_[next]);
            ++next;
        }
        targets_.back().finish();  // one context: all eyes at once
    }

    void sendPictures() const {
        for (std::size_t eye = 0; eye < targets_.size(); ++eye) {
            const EyeTarget& target = targets_[eye];
            lockstep::sendPicture(
                cluster_, {cluster_.rank(), static_cast<int>(eye), target.width(), target.height(), target.read()});
        }
    }

    [[nodiscard]] lockstep::RankReport report() const {
        return {lockstep::hostName(),     context_->renderer(),      drawMs_.percentile(0.5),
                drawMs_.percentile(0.99), drawMs_.largest(),         waitMs_.percentile(0.5),
                waitMs_.percentile(0.99), lockstep::residentBytes(), frameBufferBytes_};
    }

    const lockstep::Cluster& cluster_;
    std::optional<lockstep::BitFlip> fault_;
    walls::Wall wall_;
    const walls::Tile& tile_;
    std::unique_ptr<GlContext> context_;  // before everything that holds GL objects
    std::optional<sand::Terrain> terrain_;
    std::optional<SandView> view_;
    std::vector<EyeTarget> targets_;
    std::vector<EyeMemory> memories_;  // what each target shows already
    std::int64_t frameBufferBytes_ = 0;
    lockstep::Statistics drawMs_, waitMs_;
};

}  // namespace

int showTile(const lockstep::Cluster& cluster, Backend backend, const sand::Erosion::Options& sweeps) {
    const std::optional<lockstep::SessionMessage> message = lockstep::broadcastSession(cluster, std::nullopt);
    if (!message) {
        return 0;  // the master has said why
    }
    lockstep::Readiness readiness{lockstep::hostName(), lockstep::buildId(), ""};
    std::unique_ptr<TileSession> session;
    try {
        session = std::make_unique<TileSession>(cluster, *message, backend, sweeps);
    } catch (const std::exception& error) {
        readiness.error = error.what();
    }
    (void)lockstep::gatherReadiness(cluster, readiness);
    if (!lockstep::agreeToGoOn(cluster, false)) {
        return 0;
    }
    session->run(message->frameTimeout);
    return 0;
}

}  // namespace render_node
