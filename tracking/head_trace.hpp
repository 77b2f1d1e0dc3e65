// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <istream>
#include <string>
#include <vector>

#include "tracking/head_tracker.hpp"

namespace tracking {

/// A recorded head. The same time gives the same pose, bit for bit: only + - * / and square roots lie between.
///
/// A CSV with a header: time [s], x, y, z [m], and of the head's turn nothing, or yaw, pitch, roll [degree], or
/// qx, qy, qz, qw, or right_x, right_y, right_z, which is the direction from the left eye to the right one.
class HeadTrace {
public:
    /// Throw base::InputError with file, line and value. `name` stands for the file in messages.
    static HeadTrace load(const std::filesystem::path& file, const RoomMapping& mapping);
    static HeadTrace parse(std::istream& text, const std::string& name, const RoomMapping& mapping);

    /// `seconds` after the first sample, straight between samples; before it the first, behind the end the last.
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
