// SPDX-License-Identifier: Apache-2.0
// Fuzzes the text of --track, which names a tracker of the head and its place in the room. An accepted source has
// numbers within their limits, and its text without the place is the same source.
#include <cmath>

#include "tests/fuzz/fuzz_target.hpp"
#include "tracking/source.hpp"

namespace {

using tracking::Source;

void requireLimits(const Source& source) {
    fuzz::require(source.body >= 0 && source.body <= 999, "a body's number is out of range");
    // Each axis of the tracker is along one axis of the room, so only the sign of the volume can change.
    fuzz::require(std::abs(glm::determinant(source.axes)) == 1, "the axes are not those of a room");
    const tracking::Pose pose = source.mapping({0, 1.6, 2}).pose({.position = {0.1, -0.2, 0.3}});
    const glm::dvec3 place = pose.position;
    fuzz::require(std::abs(place.x) < 2000 && std::abs(place.y) < 2000 && std::abs(place.z) < 2000,
                  "a head is farther away than the origin's and the eyes' limits allow");
}

}  // namespace

SANDWALL_FUZZER(tracker) {
    fuzz::takeOrRefuse([&] {
        const std::string text(fuzz::textOf({data, size}));
        const Source source = Source::parse(text, "--track", "walls");
        requireLimits(source);
        const Source again = Source::parse(source.text, "--track", "walls");
        fuzz::require(again.kind == source.kind && again.file == source.file && again.host == source.host &&
                          again.port == source.port && again.body == source.body && !again.origin,
                      "a source without its place is another source");
    });
    return 0;
}
