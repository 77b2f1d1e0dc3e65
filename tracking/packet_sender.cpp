// SPDX-License-Identifier: Apache-2.0
#include "tracking/packet_sender.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "base/input_error.hpp"
#include "tracking/dtrack.hpp"
#include "tracking/opentrack.hpp"

namespace tracking {
namespace {

const Source& checked(const Source& to) {
    if (to.kind != Source::Kind::opentrack && to.kind != Source::Kind::dtrack) {
        throw base::InputError(fmt::format("--send: cannot send to '{}'; choose opentrack: or dtrack:", to.text));
    }
    if (to.axes != glm::dmat3(1.0) || to.eyes != glm::dvec3(0)) {
        throw base::InputError("--send: axes= and eyes= are for the receiver; a sender takes only origin=");
    }
    if (to.port == 0) {
        throw base::InputError(fmt::format("--send: '{}': cannot send to port 0; give the receiver's port", to.text));
    }
    return to;
}

}  // namespace

Pose sway(double seconds) {
    const double phase = seconds * std::numbers::pi / 2;
    const double yaw = 15 * std::sin(phase);
    return {{0.2 * std::sin(phase), 0.02 * std::sin(2 * phase), 0.0}, rotationOf(yaw, 0, 0)[0]};
}

PacketSender::PacketSender(const Source& to) : to_(checked(to)), socket_(to.host, to.port) {}

void PacketSender::send(const Pose& pose) {
    ++sent_;
    const Pose relative{pose.position - to_.origin.value_or(glm::dvec3(0)), pose.right};
    socket_.send(to_.kind == Source::Kind::opentrack ? opentrackPacket(relative)
                                                     : dtrackPacket(relative, sent_, to_.body));
}

}  // namespace tracking
