// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render_node/sand_surface.hpp"

namespace render_node {

/// Where the sand's vertices have changed lately, with their heights before and after and those around, by revision.
///
/// Of bounded length: old entries grow together, so that whoever asks for what happened since a revision long ago is
/// told of too large a part and never of too little.
class SandDamage {
public:
    struct Part {
        std::uint64_t revision;  // that changed it; the latest, where parts have grown together
        sand::Rect vertices;     // of the vertex grid, that may look different
        HeightRange heights;     // of all triangles that reach there, of any level
    };
    static constexpr std::size_t kMostParts = 128;

    /// Revisions must not fall.
    void add(const Part& part);
    /// All that changed after that revision, the oldest first. Good until the next add().
    [[nodiscard]] std::span<const Part> since(std::uint64_t revision) const;

private:
    std::vector<Part> parts_;  // by revision
};

}  // namespace render_node
