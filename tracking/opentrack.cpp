// SPDX-License-Identifier: Apache-2.0
#include "tracking/opentrack.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tracking {
namespace {

constexpr std::size_t kPacketSize = 6 * sizeof(double);
constexpr double kMetresPerCentimetre = 0.01;
constexpr double kLargestAngle = 360;  // [degree]

}  // namespace

Reading OpentrackReader::read(std::span<const std::uint8_t> packet, bool) {
    if (packet.size() != kPacketSize) {
        return {};
    }
    base::ByteReader reader(packet);
    std::array<double, 6> value{};
    for (double& one : value) {
        one = reader.get<double>();
    }
    for (std::size_t angle = 3; angle < 6; ++angle) {
        if (!(std::abs(value[angle]) <= kLargestAngle)) {
            return {};
        }
    }
    const Measured measured{glm::dvec3(-value[0], value[1], value[2]) * kMetresPerCentimetre,
                            rotationOf(-value[3], value[4], value[5])};
    return plausible(measured) ? Reading{Reading::Kind::pose, measured} : Reading{};
}

base::Bytes opentrackPacket(const Pose& pose) {
    base::ByteWriter writer;
    writer.put(-pose.position.x / kMetresPerCentimetre);
    writer.put(pose.position.y / kMetresPerCentimetre);
    writer.put(pose.position.z / kMetresPerCentimetre);
    writer.put(-glm::degrees(std::atan2(-pose.right.z, pose.right.x)));
    writer.put(0.0);
    writer.put(glm::degrees(std::asin(std::clamp(pose.right.y, -1.0, 1.0))));
    return writer.take();
}

}  // namespace tracking
