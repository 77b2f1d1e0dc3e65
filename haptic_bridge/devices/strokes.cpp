// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/devices/strokes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/input_error.hpp"
#include "base/number.hpp"
#include "base/text.hpp"
#include "base/text_reader.hpp"

namespace haptic_bridge {
namespace {

constexpr double kReach = 100;    // [half side]; a larger coordinate is a typing error
constexpr int kArcSegments = 64;  // segments of a full turn

/// One line of a stroke file, cut into words.
struct Line {
    const std::string& name;
    long number;
    std::vector<std::string_view> words;

    [[noreturn]] void fail(const std::string& message) const { throw base::InputError(name, number, message); }
    void expect(std::size_t count, const char* form) const {
        if (words.size() != count + 1) {
            fail(fmt::format("'{}' takes {}, got {} values", words[0], form, words.size() - 1));
        }
    }
    [[nodiscard]] double value(std::size_t index, double lowest, double highest) const {
        const std::string_view word = words[index];
        const std::optional<double> read = base::numberOf(word);
        if (!read || *read < lowest || *read > highest) {
            fail(fmt::format("'{}' needs a number from {} to {}, got '{}'", words[0], lowest, highest, word));
        }
        return *read;
    }
    [[nodiscard]] double coordinate(std::size_t index) const { return value(index, -kReach, kReach); }
};

void addArc(const Line& line, std::vector<Strokes::Point>& points) {
    line.expect(6, "CENTRE_X CENTRE_Y RADIUS_X RADIUS_Y FROM_DEG TO_DEG");
    const double from = line.value(5, -3600, 3600), to = line.value(6, -3600, 3600);
    const double rx = line.value(3, 0, kReach), ry = line.value(4, 0, kReach);
    const int segments = std::max(1, static_cast<int>(std::ceil(std::abs(to - from) / 360 * kArcSegments)));
    for (int i = 0; i <= segments; ++i) {
        const double angle = (from + (to - from) * i / segments) * std::numbers::pi / 180;
        points.push_back({line.coordinate(1) + rx * std::cos(angle), line.coordinate(2) + ry * std::sin(angle)});
    }
}

/// Returns the direction of the way [deg]; nullopt if both points are equal.
std::optional<double> courseOf(Strokes::Point from, Strokes::Point to) {
    if (from.x == to.x && from.y == to.y) {
        return std::nullopt;
    }
    return std::atan2(to.y - from.y, to.x - from.x) * 180 / std::numbers::pi;
}

/// Reads a stroke list line by line. Speed, depth and heading hold for the strokes that begin after them.
class StrokeReader {
public:
    void take(const Line& line) {
        const std::string_view word = line.words[0];
        if (word == "stroke") {
            line.expect(0, "no values");
            closeStroke(line);
            strokes_.strokes.push_back({{}, speed_, depth_, turn_});
        } else if (word == "speed") {
            line.expect(1, "HALF_SIDES_PER_SECOND");
            speed_ = line.value(1, 1e-6, 1e6);
        } else if (word == "depth") {
            line.expect(1, "TOOL_RADII");
            depth_ = line.value(1, -kReach, kReach);
        } else if (word == "travel") {
            line.expect(1, "HALF_SIDES_PER_SECOND");
            strokes_.travel = line.value(1, 1e-6, 1e6);
        } else if (word == "lift") {
            line.expect(1, "TOOL_RADII");
            strokes_.lift = line.value(1, 0, kReach);
        } else if (word == "point") {
            line.expect(2, "X Y");
            points(line).push_back({line.coordinate(1), line.coordinate(2)});
        } else if (word == "arc") {
            addArc(line, points(line));
        } else if (word == "hold") {
            line.expect(1, "SECONDS");
            lastPoint(line).hold = line.value(1, 0, 3600);
        } else if (!takeTurn(line)) {
            line.fail(fmt::format(
                "'{}' is unknown; write stroke, point, arc, hold, speed, depth, travel, lift, heading, follow or foot",
                word));
        }
    }
    [[nodiscard]] Strokes finish(const Line& end) {
        if (strokes_.strokes.empty()) {
            end.fail("no stroke in the file; write 'stroke', then 'point X Y' lines");
        }
        closeStroke(end);
        return std::move(strokes_);
    }

private:
    /// Takes a line that sets the tool's heading. Returns false if the line is of another kind.
    bool takeTurn(const Line& line) {
        const std::string_view word = line.words[0];
        if (word == "heading") {
            line.expect(1, "DEGREES");
            turn_.heading = line.value(1, -3600, 3600);
            turn_.follow = false;
        } else if (word == "follow") {
            line.expect(0, "no values");
            turn_.follow = true;
        } else if (word == "foot") {
            line.expect(1, "left or right");
            if (line.words[1] != "left" && line.words[1] != "right") {
                line.fail(fmt::format("'foot' needs left or right, got '{}'", line.words[1]));
            }
            turn_.leftFoot = line.words[1] == "left";
        } else {
            return false;
        }
        return true;
    }
    Strokes::Point& lastPoint(const Line& line) {
        if (points(line).empty()) {
            line.fail(fmt::format("'{}' before the first point of its stroke", line.words[0]));
        }
        return points(line).back();
    }
    std::vector<Strokes::Point>& points(const Line& line) {
        if (strokes_.strokes.empty()) {
            line.fail(fmt::format("'{}' before the first 'stroke'", line.words[0]));
        }
        return strokes_.strokes.back().points;
    }
    void closeStroke(const Line& line) {
        if (!strokes_.strokes.empty() && strokes_.strokes.back().points.empty()) {
            line.fail("the stroke before this line has no points");
        }
    }

    Strokes strokes_;
    double speed_ = 1, depth_ = 0.5;
    Strokes::Turn turn_;
};

}  // namespace

Strokes Strokes::parse(std::string_view text, const std::string& name) {
    StrokeReader reader;
    base::TextReader lines(text, name);
    for (std::string_view read; lines.nextLine(read);) {
        const Line line{name, lines.line(), base::words(read.substr(0, read.find('#')))};
        if (!line.words.empty()) {
            reader.take(line);
        }
    }
    return reader.finish({name, lines.line(), {}});
}

StrokeDevice::StrokeDevice(const Strokes& strokes) : hoverHeight_(1 + strokes.lift) {
    const Strokes::Point first = strokes.strokes.front().points.front();
    knots_.push_back({0, first.x, first.y, hoverHeight_, false, std::nullopt, false});
    for (const Strokes::Stroke& stroke : strokes.strokes) {
        // In the air the tool already has the heading with which the stroke begins.
        Strokes::Turn before = stroke.turn;
        if (stroke.turn.follow && stroke.points.size() > 1) {
            before.heading = courseOf(stroke.points[0], stroke.points[1]);
        }
        before.follow = false;
        moveTo(stroke.points.front(), strokes.travel, hoverHeight_, false, before);
        for (const Strokes::Point& point : stroke.points) {
            moveTo(point, stroke.speed, 1 - stroke.depth, true, stroke.turn);
        }
    }
}

void StrokeDevice::moveTo(Strokes::Point to, double speed, double z, bool engaged, const Strokes::Turn& turn) {
    const Knot from = knots_.back();
    const double distance = std::hypot(to.x - from.x, to.y - from.y);
    std::optional<double> heading = turn.heading ? turn.heading : from.heading;
    if (turn.follow) {
        const auto course = courseOf({from.x, from.y}, to);
        heading = course ? course : from.heading;
    }
    const bool leftFoot = heading.has_value() && turn.leftFoot;
    const double arrived = from.time + distance / speed;
    knots_.push_back({arrived, to.x, to.y, z, engaged, heading, leftFoot});
    if (to.hold > 0 && engaged) {
        knots_.push_back({arrived + to.hold, to.x, to.y, z, engaged, heading, leftFoot});
    }
}

Pose StrokeDevice::read(double time) {
    while (next_ < knots_.size() && knots_[next_].time < time) {
        ++next_;
    }
    if (next_ == knots_.size()) {
        const Knot& last = knots_.back();
        return {last.x, last.y, hoverHeight_, false, last.heading, last.leftFoot};
    }
    const Knot& from = knots_[next_ - 1];
    const Knot& to = knots_[next_];
    const double span = to.time - from.time;
    const double share = span > 0 ? std::clamp((time - from.time) / span, 0.0, 1.0) : 1.0;
    return {
        from.x + share * (to.x - from.x), from.y + share * (to.y - from.y), to.z, to.engaged, to.heading, to.leftFoot};
}

}  // namespace haptic_bridge
