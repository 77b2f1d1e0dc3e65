// SPDX-License-Identifier: Apache-2.0
// Fuzzes the sources of a head's pose: packets of opentrack and of DTrack, and a recorded head as CSV.
#include <cmath>
#include <sstream>

#include "tests/fuzz/fuzz_target.hpp"
#include "tracking/dtrack.hpp"
#include "tracking/head_trace.hpp"
#include "tracking/opentrack.hpp"
#include "tracking/room_mapping.hpp"

namespace {

void read(tracking::PacketReader& reader, fuzz::Input input) {
    for (const fuzz::Input packet : fuzz::piecesOf(input)) {
        const tracking::Reading reading = reader.read(packet, packet.size() % 7 == 0);
        if (reading.kind != tracking::Reading::Kind::pose) {
            continue;
        }
        const tracking::Pose pose = tracking::RoomMapping{}.pose(reading.measured);
        if (!std::isfinite(pose.position.x + pose.position.y + pose.position.z)) {
            throw std::logic_error("a head has a place that is not finite");
        }
    }
}

}  // namespace

SANDWALL_FUZZER(head) {
    if (size == 0) {
        return 0;
    }
    const fuzz::Input input = fuzz::Input(data, size).subspan(1);
    if (data[0] % 3 == 0) {
        tracking::OpentrackReader reader;
        read(reader, input);
    } else if (data[0] % 3 == 1) {
        tracking::DtrackReader reader(static_cast<int>(data[0] & 1U));
        read(reader, input);
    } else {
        fuzz::takeOrRefuse([&] {
            std::istringstream stream{std::string(fuzz::textOf(input))};
            (void)tracking::HeadTrace::parse(stream, "head.csv", {});
        });
    }
    return 0;
}
