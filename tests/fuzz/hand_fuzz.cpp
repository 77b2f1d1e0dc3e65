// SPDX-License-Identifier: Apache-2.0
// Fuzzes a recorded hand as CSV and a stroke list, and moves the hand that follows them.
#include <sstream>

#include "haptic_bridge/devices/strokes.hpp"
#include "haptic_bridge/devices/trace.hpp"
#include "tests/fuzz/fuzz_target.hpp"

SANDWALL_FUZZER(hand) {
    const std::string text(fuzz::textOf({data, size}));
    fuzz::takeOrRefuse([&] {
        haptic_bridge::StrokeDevice device(haptic_bridge::Strokes::parse(text, "hand.strokes"));
        (void)device.read(0.1);
        (void)device.read(1e9);
    });
    fuzz::takeOrRefuse([&] {
        std::istringstream stream(text);
        const haptic_bridge::HandSettings settings;
        haptic_bridge::TraceDevice device(haptic_bridge::Trace::parse(stream, "hand.csv", settings), settings, 2, 2,
                                          0.01);
        (void)device.read(0.1);
        (void)device.read(1e9);
    });
    return 0;
}
