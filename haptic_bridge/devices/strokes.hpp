// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "haptic_bridge/hand/device.hpp"

namespace haptic_bridge {

/// A list of strokes as a file gives it (docs/devices.md), in hand space.
struct Strokes {
    struct Point {
        double x = 0, y = 0;
        double hold = 0;  // [s] that the tool rests there
    };
    /// Which way the tool is turned along a stroke.
    struct Turn {
        std::optional<double> heading = std::nullopt;  // [deg]; none: as it was before
        bool follow = false;                           // along the stroke instead
        bool leftFoot = false;
    };
    struct Stroke {
        std::vector<Point> points;  // at least one
        double speed = 1;           // [half side / s]
        double depth = 0.5;         // [tool radius] of the underside under the surface
        Turn turn{};
    };
    std::vector<Stroke> strokes;  // at least one
    double travel = 4;            // [half side / s] between strokes
    double lift = 2;              // [tool radius] of the underside over the surface between strokes

    /// `name` stands for the file in messages. Throws base::InputError with its line.
    static Strokes parse(std::string_view text, const std::string& name);
};

/// The letters G I S, written large across the field; embedded from gis.strokes.
[[nodiscard]] std::string_view gisStrokes();

/// Draws strokes at their speeds, and hovers when the last is done.
class StrokeDevice : public Device {
public:
    explicit StrokeDevice(const Strokes& strokes);
    [[nodiscard]] Pose read(double time) override;
    void sendForce(sand::force::Vec3) override {}
    [[nodiscard]] bool finished(double time) const override { return time >= duration(); }
    [[nodiscard]] double duration() const { return knots_.back().time; }  // [s]

private:
    /// The hand moves from knot to knot in straight lines; `pose` holds from the knot before to this one.
    struct Knot {
        double time;
        double x, y;
        double z;
        bool engaged;
        std::optional<double> heading;  // [deg]
        bool leftFoot;
    };
    void moveTo(Strokes::Point to, double speed, double z, bool engaged, const Strokes::Turn& turn);

    std::vector<Knot> knots_;
    double hoverHeight_;
    std::size_t next_ = 1;
};

}  // namespace haptic_bridge
