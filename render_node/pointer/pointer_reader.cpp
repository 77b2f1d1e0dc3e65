// SPDX-License-Identifier: Apache-2.0
#include "render_node/pointer/pointer_reader.hpp"

#include <algorithm>
#include <array>
#include <glm/gtc/type_ptr.hpp>
#include <utility>

namespace render_node {
namespace {

using haptic_bridge::PointerReport;

/// Removes readings until a report can hold the rest. Keeps the last one, and those at which the pointer was pressed or
/// released. Removes first a reading whose neighbours are close in time.
template <class Reading>
void thin(std::vector<Reading>& readings) {
    while (readings.size() > PointerReport::kMostSamples) {
        std::size_t victim = 0;
        std::int64_t shortest = 0;
        for (std::size_t i = 1; i + 1 < readings.size(); ++i) {
            const bool turning =
                readings[i].pressed != readings[i - 1].pressed || readings[i].pressed != readings[i + 1].pressed;
            const std::int64_t gap = readings[i + 1].ns - readings[i - 1].ns;
            if (!turning && (victim == 0 || gap < shortest)) {
                victim = i;
                shortest = gap;
            }
        }
        readings.erase(readings.begin() + static_cast<std::ptrdiff_t>(victim));
    }
}

/// Adds readings halfway between two far ones of a stroke, as long as a report can hold them. So the tool follows dunes
/// also under a fast pointer. The first of `readings` is the last one of the report before, and does not count.
template <class Reading>
void fill(std::vector<Reading>& readings) {
    constexpr double kNear = 4;  // [pixel]
    while (readings.size() <= PointerReport::kMostSamples) {
        std::size_t widest = 0;
        double gap = kNear;
        for (std::size_t i = 1; i < readings.size(); ++i) {
            const double distance = glm::distance(readings[i].place.at, readings[i - 1].place.at);
            const bool stroke = readings[i].pressed && readings[i - 1].pressed &&
                                readings[i].place.output == readings[i - 1].place.output;
            if (stroke && distance > gap) {
                widest = i;
                gap = distance;
            }
        }
        if (widest == 0) {
            return;
        }
        Reading between = readings[widest];
        between.ns = (between.ns + readings[widest - 1].ns) / 2;
        between.place.at = (between.place.at + readings[widest - 1].place.at) / 2.0;
        readings.insert(readings.begin() + static_cast<std::ptrdiff_t>(widest), between);
    }
}

sand::HeightSpan inCells(const shapes::HeightRange& heights /* [scene unit] */, double cell) {
    return {heights.lowest / cell, heights.highest / cell};
}

}  // namespace

void PointerReader::follow(const PointerEvent& event, PointerReport& report) {
    using Kind = PointerEvent::Kind;
    const glm::dvec2 before = last_.at;
    last_ = {event.window, event.at};
    switch (event.kind) {
        case Kind::wheel:
            (event.control ? report.size
             : event.shift ? report.depth
                           : report.wheel) += static_cast<float>(event.notches);
            wheeled_ = last_;
            break;  // the tool goes to its new depth at once
        case Kind::turnPress:
            drag_ = Drag::turn;
            return;
        case Kind::panPress:
            drag_ = Drag::pan;
            panFrom_ = last_;
            panTo_.reset();
            panDepth_.reset();
            return;
        case Kind::viewRelease:
            drag_ = Drag::none;
            return;
        case Kind::move:
            if (drag_ == Drag::pan && !pressed_) {
                panTo_ = last_;
                return;
            }
            if (drag_ == Drag::turn && !pressed_) {
                const glm::dvec2 share =
                    (event.at - before) / glm::dvec2(walls::outputPixels(wall_.stereo, tile().pixels));
                report.turnX += static_cast<float>(share.x);
                report.turnY += static_cast<float>(share.y);
                return;
            }
            break;
        case Kind::press:
            pressed_ = true;
            ++touches_;
            touched_.forget();
            break;
        case Kind::release:
            pressed_ = false;
            break;
    }
    readings_.push_back({event.ns, last_, pressed_});
}

/// Computes the places in the room at which the view is dragged and zoomed.
void PointerReader::followView(const Shown& shown, PointerReport& report) {
    const auto floats = [](glm::dvec3 place) { return std::array{float(place.x), float(place.y), float(place.z)}; };
    if (const auto place = std::exchange(wheeled_, std::nullopt)) {
        report.wheelAt = floats(pointAt(*place, depthAt(*place, shown), shown.view));
    }
    if (panFrom_ && !panDepth_) {
        panDepth_ = depthAt(*panFrom_, shown);
    }
    if (const auto to = std::exchange(panTo_, std::nullopt)) {
        report.pan = floats(pointAt(*to, *panDepth_, shown.view) - pointAt(*panFrom_, *panDepth_, shown.view));
        panFrom_ = to;
    }
}

PointerReport PointerReader::read(std::span<const PointerEvent> events, const sand::Replica& replica,
                                  const lockstep::ViewState& view, shapes::HeightRange heights,
                                  std::int64_t clockAhead) {
    PointerReport report;
    readings_.clear();
    for (const PointerEvent& event : events) {
        follow(event, report);
    }
    const Shown shown{replica, view, heights};
    followView(shown, report);
    thin(readings_);
    if (!readings_.empty()) {
        // A pointer that rested began to move just before its first motion was read. The time at which it came to rest
        // would put the places between far apart in time, and the master would lift the tool.
        constexpr std::int64_t kMotion = 8'000'000;  // [ns], between two motions of a usual mouse
        before_.ns = std::max(before_.ns, readings_.front().ns - kMotion);
        readings_.insert(readings_.begin(), before_);
        before_ = readings_.back();
        fill(readings_);
        readings_.erase(readings_.begin());
    }
    for (const Reading& reading : readings_) {
        haptic_bridge::PointerSample& sample = report.samples[report.count++] = touched_.sample(
            sight(reading.place, shown), reading.pressed, replica, inCells(heights, replica.cellSize()));
        sample.readNs = reading.ns - clockAhead;
    }
    report.pressed = pressed_ ? 1 : 0;
    report.touch = touches_;
    if (!pressed_) {
        touched_.forget();
    }
    return report;
}

haptic_bridge::Ray PointerReader::sight(const WindowPlace& place, const Shown& shown) const {
    const lockstep::ViewState& view = shown.view;
    const glm::dvec3 eye(view.head[0], view.head[1], view.head[2]);
    const Ray units = sightRay(eye, roomPoint(wall_, tile(), place), glm::make_mat4(view.sceneToRoom.data()));
    const auto cells = [cell = shown.replica.cellSize()](glm::dvec3 point) {
        return sand::force::Vec3{point.x / cell, point.y / cell, point.z / cell};
    };
    return {cells(units.from), cells(units.along)};
}

glm::dvec3 PointerReader::pointAt(const WindowPlace& place, double depth, const lockstep::ViewState& view) const {
    const glm::dvec3 eye(view.head[0], view.head[1], view.head[2]);
    const glm::dvec3 along = roomPoint(wall_, tile(), place) - eye;
    return eye + along * (depth / glm::dot(along, -tile().screen.normal()));
}

double PointerReader::depthAt(const WindowPlace& place, const Shown& shown) const {
    const glm::dvec3 eye(shown.view.head[0], shown.view.head[1], shown.view.head[2]);
    glm::dvec3 point = wall_.stage.centre;
    const double cell = shown.replica.cellSize();
    if (const auto sand = touched_.meet(sight(place, shown), false, shown.replica, inCells(shown.heights, cell))) {
        constexpr double kProbe = sand::kProbePerCell;
        const double height = touched_.height(shown.replica, false, sand->x * kProbe, sand->y * kProbe);
        const glm::dvec3 cells(sand->x, sand->y, height / sand::kUnitsPerCell);
        const glm::dmat4 toRoom = glm::make_mat4(shown.view.sceneToRoom.data());
        point = glm::dvec3(toRoom * glm::dvec4(cells * cell, 1));
    }
    return glm::dot(point - eye, -tile().screen.normal());
}

}  // namespace render_node
