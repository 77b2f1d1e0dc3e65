// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "haptic_bridge/hand/device.hpp"

namespace haptic_bridge {

/// A list of strokes from a file (docs/devices.md), in hand space.
struct Strokes {
    struct Point {
        double x = 0, y = 0;
        double hold = 0;  // [s], time that the tool rests at the point
    };
    /// Heading of the tool along a stroke.
    struct Turn {
        std::optional<double> heading = std::nullopt;  // [deg]; nullopt: as before
        bool follow = false;                           // true: the tool turns into the direction of the stroke
        bool leftFoot = false;
    };
    struct Stroke {
        std::vector<Point> points;  // at least one
        double speed = 1;           // [half side / s]
        double depth = 0.5;         // [tool radius], depth of the underside below the surface
        Turn turn{};
    };
    std::vector<Stroke> strokes;  // at least one
    double travel = 4;            // [half side / s] between strokes
    double lift = 2;              // [tool radius], height of the underside above the surface between strokes

    /// Parses the text of a stroke list. Throws base::InputError with `name`, which messages show as the file, and with
    /// the line.
    static Strokes parse(std::string_view text, const std::string& name);
};

/// Returns a stroke list that writes the letters G I S across the field. It is embedded from gis.strokes.
[[nodiscard]] std::string_view gisStrokes();

/// A device that draws strokes at their speeds, and hovers after the last one.
class StrokeDevice : public Device {
public:
    explicit StrokeDevice(const Strokes& strokes);
    [[nodiscard]] Pose read(double time) override;
    void sendForce(sand::force::Vec3) override {}
    [[nodiscard]] bool finished(double time) const override { return time >= duration(); }
    [[nodiscard]] double duration() const { return knots_.back().time; }  // [s]

private:
    /// Point on the path of the hand, which moves in straight lines from knot to knot. Height, touch and heading hold
    /// from the previous knot up to this one.
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
