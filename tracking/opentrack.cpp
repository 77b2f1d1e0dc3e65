// SPDX-License-Identifier: Apache-2.0
#include "tracking/opentrack.hpp"

#include <algorithm>
#include <cmath>

#include "base/field_forms.hpp"

namespace tracking {
namespace {

constexpr double kMetresPerCentimetre = 0.01;
constexpr double kLargestAngle = 360;  // [degree]

/// A packet as opentrack sends it. Any number can be NaN.
struct Packet {
    double x = 0, y = 0, z = 0;           // [cm]
    double yaw = 0, pitch = 0, roll = 0;  // [degree]
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("x", base::anyFloat(it.x));
        visit("y", base::anyFloat(it.y));
        visit("z", base::anyFloat(it.z));
        visit("yaw", base::anyFloat(it.yaw));
        visit("pitch", base::anyFloat(it.pitch));
        visit("roll", base::anyFloat(it.roll));
    }
};
constexpr std::size_t kPacketSize = 6 * sizeof(double);

}  // namespace

Reading OpentrackReader::read(std::span<const std::uint8_t> packet, bool) {
    if (packet.size() != kPacketSize) {
        return {};
    }
    const auto [x, y, z, yaw, pitch, roll] = base::decoded<Packet>(packet);
    for (const double angle : {yaw, pitch, roll}) {
        if (!(std::abs(angle) <= kLargestAngle)) {
            return {};
        }
    }
    const Measured measured{glm::dvec3(-x, y, z) * kMetresPerCentimetre, rotationOf(-yaw, pitch, roll)};
    return plausible(measured) ? Reading{Reading::Kind::pose, measured} : Reading{};
}

base::Bytes opentrackPacket(const Pose& pose) {
    return base::encoded(Packet{.x = -pose.position.x / kMetresPerCentimetre,
                                .y = pose.position.y / kMetresPerCentimetre,
                                .z = pose.position.z / kMetresPerCentimetre,
                                .yaw = -glm::degrees(std::atan2(-pose.right.z, pose.right.x)),
                                .pitch = 0,
                                .roll = glm::degrees(std::asin(std::clamp(pose.right.y, -1.0, 1.0)))});
}

}  // namespace tracking
