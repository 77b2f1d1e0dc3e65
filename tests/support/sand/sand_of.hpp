// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "sand/grid/surface.hpp"
#include "sand/replica.hpp"
#include "sand/tin/geometry/surface_view.hpp"

/// Access to the sand of a replica, for tests that know its kind. Each function throws if the sand is of the other
/// kind.
namespace samples {

/// Returns a replica of a height field that is swept with these options.
inline sand::Replica replicaSwept(const sand::Start& start, const sand::grid::Erosion::Options& options) {
    return {start, std::make_unique<sand::grid::GridSurface>(start.rules, start.terrain, start.ground, options)};
}

inline const sand::HeightField& fieldOf(const sand::Replica& replica) {
    return std::get<sand::GridData>(replica.surface().data()).field;
}

inline const sand::grid::Erosion& erosionOf(const sand::Replica& replica) {
    return dynamic_cast<const sand::grid::GridSurface&>(replica.surface()).erosion();
}

inline const sand::tin::SurfaceView& tinOf(const sand::Replica& replica) {
    return std::get<sand::TinData>(replica.surface().data()).view;
}

/// Returns every cell that may have changed since the last call.
inline std::vector<sand::CellRect> takeCells(sand::Replica& replica) {
    const sand::SurfaceChange change = replica.takeChange();
    return change.whole ? std::vector{fieldOf(replica).bounds()} : std::get<sand::CellChange>(change.parts).cells;
}

}  // namespace samples
