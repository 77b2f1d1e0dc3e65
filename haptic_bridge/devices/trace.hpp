// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <istream>
#include <string>
#include <vector>

#include "haptic_bridge/hand/device.hpp"
#include "haptic_bridge/hand/hand_settings.hpp"

namespace haptic_bridge {

/// A recorded hand: samples at their own times, with the jitter and the gaps of a real device.
struct Trace {
    struct Sample {
        double time = 0;                // [s] since the first sample, never decreasing
        std::array<double, 3> place{};  // [unit of the trace], in the trace's axes x, y, z
    };
    std::vector<Sample> samples;  // at least two

    /// A CSV with a header line; times are numbers, or "YYYY/MM/DD/HH:MM:SS.ffffff". `name` stands for the file in
    /// messages. Throws base::InputError with its line.
    static Trace parse(std::istream& text, const std::string& name, const HandSettings& settings);
};

/// Replays a trace through the mapping, straight between samples by time, and hovers when it is over.
class TraceDevice : public Device {
public:
    /// The field's extent and the tool's radius are in scene units; the median and the bounding box of the trace are
    /// taken once, here.
    TraceDevice(const Trace& trace, const HandSettings& settings, double fieldWidth, double fieldHeight,
                double toolRadius);
    [[nodiscard]] Pose read(double time) override;
    void sendForce(sand::force::Vec3) override {}
    [[nodiscard]] bool finished(double time) const override { return time > knots_.back().time; }

private:
    struct Knot {
        double time;              // [s]
        sand::force::Vec3 place;  // [unit of the trace], east, north, up
    };
    std::vector<Knot> knots_;
    HandSettings settings_;
    sand::force::Vec3 origin_;              // [unit of the trace], east, north, up
    double horizontal_ = 1, vertical_ = 1;  // hand space per unit of the trace
    std::size_t next_ = 1;
};

}  // namespace haptic_bridge
