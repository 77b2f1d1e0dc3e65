// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <istream>
#include <string>
#include <vector>

#include "tracking/head_tracker.hpp"

namespace tracking {

/// Recorded poses of a head. Equal times give equal poses, bit for bit, because at() uses only + - * / and square
/// roots.
///
/// The file is a CSV with a header, separated by commas, or by semicolons or tabs with decimal points or commas. Its
/// columns are time [s] and x, y, z [m]. If the head turns, one of three groups follows: yaw, pitch, roll [degree]; qx,
/// qy, qz, qw; or right_x, right_y, right_z. The last group is the direction from the left eye to the right one.
class HeadTrace {
public:
    /// Both functions throw base::InputError with file, line and value. Messages give `name` as the file's name.
    static HeadTrace load(const std::filesystem::path& file, const RoomMapping& mapping);
    static HeadTrace parse(std::istream& text, const std::string& name, const RoomMapping& mapping);

    /// Returns the pose at `seconds` after the first sample, interpolated linearly. Before the first sample it returns
    /// the first pose, after the last one the last pose.
    [[nodiscard]] Pose at(double seconds) const;
    [[nodiscard]] double duration() const { return samples_.back().time; }  // [s]

private:
    struct Sample {
        double time = 0;  // [s] since the first sample, never decreasing
        Pose pose;
    };
    std::vector<Sample> samples_;  // at least one
};

class TraceTracker : public HeadTracker {
public:
    explicit TraceTracker(HeadTrace trace) : trace_(std::move(trace)) {}
    [[nodiscard]] std::optional<Pose> newest(double seconds) override { return trace_.at(seconds); }

private:
    HeadTrace trace_;
};

}  // namespace tracking
