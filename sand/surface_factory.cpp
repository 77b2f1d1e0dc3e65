// SPDX-License-Identifier: Apache-2.0
#include "sand/surface_factory.hpp"

#include <optional>

#include "base/float_environment.hpp"
#include "sand/grid/surface.hpp"
#include "sand/tin/refine/start_maker.hpp"
#include "sand/tin/surface.hpp"

namespace sand {
namespace {

/// The heights of a Start, which are unpacked at their first use. Used by one thread.
class PackedHeights {
public:
    explicit PackedHeights(const Start& start)
        : packed_(start.packed),
          columns_(start.rules.columns),
          rows_(start.rules.rows),
          cellSize_(start.terrain.cellSize()) {}
    const HeightField& field() {
        if (!field_) {
            field_ = unpackedHeights(*packed_, columns_, rows_, cellSize_);
        }
        return *field_;
    }

private:
    std::shared_ptr<const base::Bytes> packed_;
    int columns_, rows_;
    double cellSize_;  // [scene unit]
    std::optional<HeightField> field_;
};

}  // namespace

std::unique_ptr<Surface> makeSurface(const Start& start, const base::Executor* executor) {
    (void)base::needDefaultFloats();
    if (start.tin != nullptr) {
        return std::make_unique<tin::TinSurface>(start.rules, start.tin);
    }
    return std::make_unique<grid::GridSurface>(start.rules, start.volumeTaken ? start.heightsAgain() : start.terrain,
                                               start.ground, grid::Erosion::Options{.executor = executor},
                                               start.packed);
}

std::unique_ptr<Surface> makeSurfaceOfTaken(Start& start, const base::Executor* executor) {
    if (start.tin != nullptr || start.volumeTaken) {
        return makeSurface(start, executor);
    }
    return std::make_unique<grid::GridSurface>(start.rules, start.takeHeights(), start.ground,
                                               grid::Erosion::Options{.executor = executor}, start.packed);
}

std::int64_t volumeOf(const Start& start) {
    return start.tin != nullptr ? makeSurface(start)->volume() : start.volumeOfHeights().value();
}

HeightAt startHeights(const Start& start, Heights when) {
    if (start.tin != nullptr) {
        const std::shared_ptr<const Surface> tin = makeSurface(start);
        return [tin](double x, double y) { return tin->height(x, y); };
    }
    if (start.packed != nullptr && (when == Heights::atFirstUse || start.volumeTaken)) {
        const auto packed = std::make_shared<PackedHeights>(start);
        if (when == Heights::now) {
            (void)packed->field();
        }
        return [packed](double x, double y) { return packed->field().interpolated(x, y); };
    }
    const auto field =
        std::make_shared<const HeightField>(start.terrain);  // a copy, because Start may drop its heights
    return [field](double x, double y) { return field->interpolated(x, y); };
}

void startFrom(const Surface& surface, Start& start) {
    const SurfaceData data = surface.data();
    if (const auto* grid = std::get_if<GridData>(&data)) {
        start.terrain = grid->field;
        start.packed = nullptr;
    } else {
        const auto& tin = dynamic_cast<const tin::TinSurface&>(surface);
        start.beginAs(tin::startOf(tin.layer(), tin.start().settings));
    }
}

}  // namespace sand
