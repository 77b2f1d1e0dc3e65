// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/loop/tick_replay.hpp"

#include <utility>

#include "haptic_bridge/loop/felt_sand.hpp"
#include "scene/model/scene.hpp"

namespace haptic_bridge {

/// Device that returns the readings of the session's device.
class TickReplay::Player : public Device {
public:
    explicit Player(TrackHeader header) : header_(std::move(header)) {}
    void set(const TickInput& input) { input_ = input; }

    [[nodiscard]] Pose read(double) override { return input_.pose; }
    void sendForce(sand::force::Vec3) override {}
    [[nodiscard]] const ArmPhysics* physics() const override { return header_.body ? &header_.physics : nullptr; }
    [[nodiscard]] double scale() const override { return header_.scale; }
    [[nodiscard]] ArmReading reading() const override { return input_.reading; }
    [[nodiscard]] bool answers() const override { return !input_.silent; }
    [[nodiscard]] bool finished(double) const override { return false; }

private:
    TrackHeader header_;
    TickInput input_;
};

TickReplay::TickReplay(const scene::Scene& scene, const std::vector<base::Bytes>& pieces) : scene_(&scene) {
    for (const base::Bytes& bytes : pieces) {
        TrackPiece piece = decodeTrackPiece(bytes);
        sitting_ = piece.begins ? piece.sitting : sitting_;
        // Leaves out the rest of a previous link.
        if (piece.sitting == sitting_ && (piece.begins || !pieces_.empty())) {
            pieces_.push_back(std::move(piece));
        }
    }
}

void TickReplay::begin(const TrackPiece& piece) {
    auto player = std::make_unique<Player>(piece.header);
    player_ = player.get();
    hand_ = std::make_unique<HapticTick>(*scene_, std::move(player), piece.header.datum,
                                         piece.header.literal ? Guards::Mode::literal : Guards::Mode::on);
}

void TickReplay::tick(const TickInput& input, const sand::Replica& replica, std::string& rows) {
    if (surface_.patch.empty() || surface_.step != replica.stepNumber() || surface_.probe != input.surfaceProbe) {
        takeSurface(replica, input.surfaceProbe, surface_);
    }
    surface_.timeNs = input.nowNs - input.surfaceAgeNs;
    surface_.stepNs = input.nowNs - input.stepAgeNs;
    surface_.talus = input.talus;
    surface_.edits += input.edited ? 1 : 0;
    hand_->shareForce(input.share);
    hand_->trip(input.tripped);
    player_->set(input);
    (void)hand_->tick(input.time, input.nowNs, surface_);
    appendRow(hand_->lastTick(), rows);
}

void TickReplay::feel(const sand::Replica& replica, std::string& rows) {
    while (!pieces_.empty()) {
        const TrackPiece& piece = pieces_.front();
        if (piece.begins) {
            begin(piece);
        }
        while (next_ < piece.ticks.size()) {
            if (piece.ticks[next_].surfaceStep > replica.stepNumber()) {
                return;
            }
            tick(piece.ticks[next_++], replica, rows);
        }
        next_ = 0;
        pieces_.pop_front();
    }
}

std::size_t TickReplay::left() const {
    std::size_t count = 0;
    for (const TrackPiece& piece : pieces_) {
        count += piece.ticks.size();
    }
    return count - next_;
}

}  // namespace haptic_bridge
