// SPDX-License-Identifier: Apache-2.0
#include "tracking/vrpn_tracker.hpp"

#include <vrpn_Tracker.h>

#include <glm/gtc/quaternion.hpp>
#include <utility>

namespace tracking {
namespace {

/// VRPN calls back from mainloop(), so all of it happens in newest().
class VrpnTracker : public HeadTracker {
public:
    VrpnTracker(const Source& source, const RoomMapping& mapping, Say say, Clock clock)
        : mapping_(mapping),
          clock_(std::move(clock)),
          presence_(source.text, std::move(say)),
          remote_(source.device.c_str()) {
        remote_.register_change_handler(this, &VrpnTracker::changed, 0);
    }

    [[nodiscard]] std::optional<Pose> newest(double) override {
        arrived_ = false;
        remote_.mainloop();
        presence_.look(arrived_, clock_());
        return last_;
    }

    [[nodiscard]] Counters counters() const override {
        Counters counters = counters_;
        counters.timesLost = presence_.timesLost();
        return counters;
    }

private:
    static void VRPN_CALLBACK changed(void* self, const vrpn_TRACKERCB report) {
        static_cast<VrpnTracker*>(self)->take(report);
    }

    void take(const vrpn_TRACKERCB& report) {
        ++counters_.packets;
        const glm::dquat turn(report.quat[3], report.quat[0], report.quat[1], report.quat[2]);
        const Measured measured{{report.pos[0], report.pos[1], report.pos[2]}, glm::mat3_cast(turn)};
        if (!plausible(measured)) {
            ++counters_.refused;
            return;
        }
        last_ = mapping_.pose(measured);
        arrived_ = true;
    }

    RoomMapping mapping_;
    Clock clock_;
    Presence presence_;
    vrpn_Tracker_Remote remote_;
    Counters counters_;
    std::optional<Pose> last_;
    bool arrived_ = false;
};

}  // namespace

std::unique_ptr<HeadTracker> openVrpn(const Source& source, const RoomMapping& mapping, Say say, Clock clock) {
    return std::make_unique<VrpnTracker>(source, mapping, std::move(say), std::move(clock));
}

}  // namespace tracking
