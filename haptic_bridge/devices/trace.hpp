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

/// A recorded hand. The samples keep their own times, with the jitter and the gaps of a real device.
struct Trace {
    struct Sample {
        double time = 0;                // [s] since the first sample, never decreasing
        std::array<double, 3> place{};  // [unit of the trace], in the trace's axes x, y, z
    };
    std::vector<Sample> samples;  // at least two

    /// Parses a CSV with a header line, separated by commas, or by semicolons or tabs with decimal points or commas.
    /// Times are numbers, or have the form "YYYY/MM/DD/HH:MM:SS.ffffff". Throws base::InputError with `name`, which
    /// messages show as the file, and with the line.
    static Trace parse(std::istream& text, const std::string& name, const HandSettings& settings);
};

/// A device that replays a trace through the mapping. It interpolates linearly between samples by time, and hovers
/// after the last one.
class TraceDevice : public Device {
public:
    /// `fieldWidth`, `fieldHeight` and `toolRadius` are in scene units. The constructor computes the median and the
    /// bounding box of the trace once.
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
    double horizontal_ = 1, vertical_ = 1;  // [hand space/unit of the trace]
    std::size_t next_ = 1;
};

}  // namespace haptic_bridge
