// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "render_node/gl/gl_program.hpp"
#include "render_node/surface/frustum.hpp"
#include "render_node/surface/height_range.hpp"
#include "render_node/surface/level_rule.hpp"
#include "render_node/surface/sand_rim.hpp"
#include "sand/model/surface_data.hpp"

namespace render_node {

/// The level at which each chunk was drawn; −1 where it was out of sight. Empty for a field that has no levels.
using DrawnLevels = std::vector<std::int8_t>;

/// The surface of the sand in GL, whatever the terrain is made of: what ScenePainter lights, bounds and draws anew.
///
/// Every camera gets the same vertices. One thread, its context current.
class DrawnSurface {
public:
    struct Drawn {
        int chunks = 0;
        int coarseChunks = 0;  // above level 0
        int triangles = 0;
    };

    DrawnSurface() = default;
    DrawnSurface(const DrawnSurface&) = delete;
    DrawnSurface& operator=(const DrawnSurface&) = delete;
    virtual ~DrawnSurface() = default;

    /// Takes over what changed of the sand, which must be of the kind and size that this surface was made of; copies
    /// it. `cameras` (each from the scene to clip coordinates) are the only ones that draw before the next update: what
    /// none of them sees may be put off until one does. Without any, all of it counts as seen.
    /// @return Whether rim() is another.
    [[nodiscard]] virtual bool update(const sand::SurfaceData& data, const sand::SurfaceChange& change,
                                      std::span<const glm::dmat4> cameras) = 0;

    /// Sets the uniforms that are the surface's own. The program must be in use.
    virtual void prepare(const GlProgram& program) const = 0;

    /// Draws the chunks that reach into the frustum of `sceneToClip`, which may show a part of what `rule` is for; all
    /// of them when `culling` is off. The program must be in use, or `before` choose one by the box of each chunk.
    virtual Drawn draw(const glm::dmat4& sceneToClip, bool culling, const LevelRule& rule,
                       const std::function<void(const Box&)>& before) = 0;
    /// Draws, over wires, what this kind of surface marks on them. `prepare` says which program is to be used.
    virtual void drawMarks(const glm::dmat4& sceneToClip, bool culling,
                           const std::function<void(const GlProgram&)>& prepare) {
        (void)sceneToClip, (void)culling, (void)prepare;
    }

    /// The levels at which draw() draws all that reaches into this frustum, its neighbours' with them.
    [[nodiscard]] virtual DrawnLevels levelsWithin(const glm::dmat4& sceneToClip, const LevelRule& rule) = 0;
    /// Where the picture differs from one that was drawn at that revision, of the same rule, at these levels. Brings
    /// them up to date.
    [[nodiscard]] virtual std::vector<Box> changesSince(std::uint64_t revision, DrawnLevels& levels,
                                                        const LevelRule& rule) = 0;
    /// Counts the updates that changed something.
    [[nodiscard]] virtual std::uint64_t revision() const = 0;
    /// The lowest and the highest that any sand has been.
    [[nodiscard]] virtual HeightRange heightsEver() const = 0;
    /// Where the sand is cut, as it now is.
    [[nodiscard]] virtual SandRim rim() const = 0;

    [[nodiscard]] virtual int chunks() const = 0;
    /// Bytes of vertices and indices in GL.
    [[nodiscard]] virtual std::size_t bytes() const = 0;
    /// Heights that updates have read so far, or vertices and triangles of a TIN: for measurements.
    [[nodiscard]] virtual std::int64_t placesRead() const = 0;
};

}  // namespace render_node
