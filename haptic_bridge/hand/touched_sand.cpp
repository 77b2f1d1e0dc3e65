// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/hand/touched_sand.hpp"

#include "sand/model/mean_height.hpp"

namespace haptic_bridge {
namespace {

constexpr double kProbe = sand::kProbePerCell;

}  // namespace

std::optional<FieldPlace> TouchedSand::meet(const Ray& ray, bool pressed, const sand::Replica& replica,
                                            const sand::HeightSpan& heights) const {
    const sand::Rules& rules = replica.rules();
    // The heights may be those of an earlier picture.
    const double margin = 2 * replica.toolRadius() / replica.cellSize();
    const SandBody sand{
        static_cast<double>(rules.columns),
        static_cast<double>(rules.rows),
        heights.lowest - margin,
        heights.highest + margin,
        0.5,
        [&](double x, double y) { return height(replica, pressed, x * kProbe, y * kProbe) / sand::kUnitsPerCell; }};
    return meetSand(ray, sand);
}

double TouchedSand::height(const sand::Replica& replica, bool pressed, double x, double y) const {
    const sand::Surface& now = replica.surface();
    if (pressed && touched_ != nullptr) {
        return touched_->height(x, y);
    }
    if (pressed && replica.engaged()) {
        if (const std::optional<double> before = now.keptHeight(x, y)) {
            return *before;
        }
    }
    return now.height(x, y);
}

PointerSample TouchedSand::sample(const Ray& ray, bool pressed, const sand::Replica& replica,
                                  const sand::HeightSpan& heights) {
    if (pressed && touched_ == nullptr && !replica.surface().readsKept()) {
        touched_ = replica.surface().clone();
    }
    PointerSample sample;
    sample.pressed = pressed ? 1 : 0;
    const std::optional<FieldPlace> place = meet(ray, pressed, replica, heights);
    if (!place) {
        return sample;
    }
    constexpr int kSamples = 5;  // across and along the tool
    const auto heightAt = [&](double x, double y) { return height(replica, pressed, x, y); };
    const double mean =
        sand::meanHeight(heightAt, place->x * kProbe, place->y * kProbe, replica.rules().tuning.tool.radius, kSamples);
    sample.probe = sand::probePoint(place->x, place->y, mean / sand::kUnitsPerCell);
    sample.meets = 1;
    return sample;
}

}  // namespace haptic_bridge
