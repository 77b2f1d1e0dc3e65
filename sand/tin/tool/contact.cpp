// SPDX-License-Identifier: Apache-2.0
// A tool that is held still. Its imprint is in the mesh only while it touches sand.
#include <algorithm>
#include <array>

#include "sand/tin/tool/displacement.hpp"

namespace sand::tin {
namespace {

constexpr double kClear = kUnitsPerCell / 8.0;  // a tool that is so far above all sand touches none [unit]
constexpr double kEntered = 1;                  // sand so far above the underside has entered the tool [unit]

}  // namespace

Displacement::Work Displacement::hold(VertexSand& layer, Imprint& imprint, Rim rim, const ProbePoint& probe) {
    const Box box = reach(probe).clippedTo(layer.triangles());
    if (box.empty()) {
        return {};
    }
    if (imprint.pose) {
        const double clear = lowestUnderside(probe.z) - kClear;
        if (rules_.keepsConstraints || imprint.isAnyAbove(layer, clear)) {  // nearly always, and cheap
            return {};
        }
        neighbourhood_->look(layer.triangles(), box);
        if (!isAnyAbove(layer, clear)) {
            leave(layer, imprint);
        }
        return {};
    }
    return isEntered(layer, probe) ? drag(layer, imprint, rim, std::array{probe}) : Work{};
}

bool Displacement::isEntered(const VertexSand& layer, const ProbePoint& probe) const {
    const Holes* const holes = isNearHole(layer, reach(probe)) ? layer.mesh().holes().get() : nullptr;
    const PlacedOutline outline = placed(outline_, probe.x, probe.y, layer.triangles(), holes);
    std::int32_t from = kNoNumber;
    return std::any_of(outline.points.begin(), outline.points.end(), [&](const LatticePoint& place) {
        const Offset offset{std::int64_t{place.x} - probe.x, std::int64_t{place.y} - probe.y};
        const std::int32_t underside = turned_.underside(probe.z, offset);
        const Located found = locate(layer.triangles(), place, from);
        from = found.triangle;
        return underside != TurnedShape::kFree && layer.heightAt(found) > underside + kEntered;
    });
}

}  // namespace sand::tin
