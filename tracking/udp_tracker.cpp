// SPDX-License-Identifier: Apache-2.0
#include "tracking/udp_tracker.hpp"

#include <utility>

namespace tracking {

UdpTracker::UdpTracker(const Source& source, const RoomMapping& mapping, std::unique_ptr<PacketReader> reader,
                       Print print, Clock clock)
    : mapping_(mapping),
      receiver_(source.host, source.port, source.from, source.text),
      reader_(std::move(reader)),
      clock_(std::move(clock)),
      presence_(source.text, std::move(print)) {}

bool UdpTracker::take(std::span<const std::uint8_t> packet, bool gone) {
    ++counters_.packets;
    const Reading reading = reader_->read(packet, gone);
    switch (reading.kind) {
        case Reading::Kind::pose:
            last_ = mapping_.pose(reading.measured);
            return true;
        case Reading::Kind::refused:
            ++counters_.refused;
            break;
        case Reading::Kind::old:
            ++counters_.old;
            break;
        case Reading::Kind::absent:
            ++counters_.absent;
            break;
    }
    return false;
}

std::optional<Pose> UdpTracker::newest(double) {
    bool pose = false;
    for (int i = 0; i < kMostPackets; ++i) {
        const auto packet = receiver_.next();
        if (!packet) {
            break;
        }
        pose = take(*packet, presence_.gone() && !pose) || pose;
    }
    presence_.look(pose, clock_());
    return last_;
}

Counters UdpTracker::counters() const {
    Counters counters = counters_;
    counters.timesLost = presence_.timesLost();
    counters.strangers = receiver_.strangers();
    return counters;
}

}  // namespace tracking
