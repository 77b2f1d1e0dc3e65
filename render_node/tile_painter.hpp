// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "lockstep/frame_message.hpp"
#include "render_node/eye_target.hpp"
#include "render_node/gl/gl_context.hpp"
#include "render_node/sand_view.hpp"
#include "sand/terrain.hpp"
#include "walls/wall.hpp"

namespace render_node {

/// Draws one tile: an eye target for each eye that the wall shows, and what its outputs make of them.
///
/// Everything follows from the wall, the sand and the frame's view, so that tiles join. Needs its context current; one
/// thread.
class TilePainter {
public:
    /// `wall`, `tile` must outlive it. Throws std::runtime_error when a shader does not compile or a size is refused.
    TilePainter(const walls::Wall& wall, const walls::Tile& tile, const sand::Scene& scene);

    /// Brings every eye that differs up to date with `terrain` as `view` sees it.
    void paint(sand::Terrain& terrain, const lockstep::ViewState& view);
    /// What each output shows, in the order of tile.outputs; good until the next paint().
    [[nodiscard]] std::vector<OutputPicture> outputs();

    /// Each eye's picture, in the order of walls::eyesOf.
    [[nodiscard]] std::span<const EyeTarget> eyes() const { return targets_; }
    [[nodiscard]] std::int64_t frameBufferBytes() const;

private:
    const walls::Wall& wall_;
    const walls::Tile& tile_;
    SandView sand_;
    std::vector<EyeTarget> targets_;
    std::vector<EyeMemory> memories_;  // what each target shows already
};

}  // namespace render_node
