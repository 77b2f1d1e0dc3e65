// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sand/grid/surface.hpp"
#include "sand/replica.hpp"
#include "sand/tin/geometry/surface_view.hpp"

/// The sand of a replica, for tests that know what it is made of. Each throws when it is made of the other.
namespace samples {

inline const sand::HeightField& fieldOf(const sand::Replica& terrain) {
    return std::get<sand::GridData>(terrain.surface().data()).field;
}

inline const sand::grid::Erosion& erosionOf(const sand::Replica& terrain) {
    return dynamic_cast<const sand::grid::GridSurface&>(terrain.surface()).erosion();
}

inline const sand::tin::SurfaceView& tinOf(const sand::Replica& terrain) {
    return std::get<sand::TinData>(terrain.surface().data()).view;
}

/// Every cell that may have changed since this was asked for last.
inline std::vector<sand::CellRect> takeCells(sand::Replica& terrain) {
    const sand::SurfaceChange change = terrain.takeChange();
    return change.whole ? std::vector{fieldOf(terrain).bounds()} : std::get<sand::CellChange>(change.parts).cells;
}

}  // namespace samples
