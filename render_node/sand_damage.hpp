// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render_node/frustum.hpp"

namespace render_node {

/// Where the sand's picture has changed lately: boxes in the scene, old heights and new within, by revision.
///
/// Of bounded length: old entries grow together, so that whoever asks for what happened since a revision long ago is
/// told of too large a box and never of too little.
class SandDamage {
public:
    struct Part {
        std::uint64_t revision;  // that changed it; the latest, where parts have grown together
        Box box;                 // [scene unit]
    };
    static constexpr std::size_t kMostParts = 128;

    /// Revisions must not fall.
    void add(std::uint64_t revision, const Box& box);
    /// All that changed after that revision, the oldest first. Good until the next add().
    [[nodiscard]] std::span<const Part> since(std::uint64_t revision) const;

private:
    std::vector<Part> parts_;  // by revision
};

}  // namespace render_node
