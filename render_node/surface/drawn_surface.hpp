// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "render_node/gl/gl_program.hpp"
#include "render_node/surface/level_rule.hpp"
#include "sand/model/surface_data.hpp"
#include "shapes/model/box.hpp"
#include "shapes/model/height_range.hpp"
#include "shapes/model/sand_rim.hpp"

namespace render_node {

/// Level at which each chunk was drawn; −1 if it was out of sight. Empty for a field without levels.
using DrawnLevels = std::vector<std::int8_t>;

/// Returns the program that draws a chunk with this box.
using ProgramChoice = std::function<const GlProgram&(const shapes::Box&)>;

/// Surface of the sand in GL, for height fields and TINs. ScenePainter lights it, bounds its changes and draws them.
///
/// All cameras get the same vertices. Used by one thread, with its context current.
class DrawnSurface {
public:
    struct Drawn {
        int chunks = 0;
        int coarseChunks = 0;  // above level 0
        int triangles = 0;
    };

    /// Work since the surface was made. For measurements.
    struct Work {
        std::int64_t vertices = 0;        // computed and sent to GL
        std::int64_t measuredChunks = 0;  // whose errors were computed at all levels
    };

    DrawnSurface() = default;
    DrawnSurface(const DrawnSurface&) = delete;
    DrawnSurface& operator=(const DrawnSurface&) = delete;
    virtual ~DrawnSurface() = default;

    /// Copies the changes of the sand. The sand must have the kind and size for which this surface was made.
    ///
    /// @param cameras  Matrices from the scene to clip coordinates. Only these cameras draw before the next update.
    ///          Changes that no camera sees may be postponed until one does. An empty list means that all changes are
    ///          seen.
    /// @return Whether rim() has changed.
    [[nodiscard]] virtual bool update(const sand::SurfaceData& data, const sand::SurfaceChange& change,
                                      std::span<const glm::dmat4> cameras) = 0;

    /// Sets the uniforms of this kind of surface. The program must be in use.
    virtual void prepare(const GlProgram& program) const = 0;

    /// Draws the chunks that reach into the frustum of `sceneToClip`, or all chunks if `culling` is false. The frustum
    /// may be a part of the picture for which `rule` was made. Either the program is in use, or `choose` returns one
    /// for the box of each chunk.
    virtual Drawn draw(const glm::dmat4& sceneToClip, bool culling, const LevelRule& rule,
                       const ProgramChoice& choose) = 0;
    /// Draws the marks of this kind of surface over the wires. `prepare` is called with the program and must set it up.
    virtual void drawMarks(const glm::dmat4& sceneToClip, bool culling,
                           const std::function<void(const GlProgram&)>& prepare) {
        (void)sceneToClip, (void)culling, (void)prepare;
    }

    /// Returns the levels at which draw() draws the chunks in this frustum, and the levels of their neighbours.
    [[nodiscard]] virtual DrawnLevels levelsWithin(const glm::dmat4& sceneToClip, const LevelRule& rule) = 0;
    /// Returns boxes around all differences from a picture that was drawn at `revision` by the same rule at these
    /// levels. Updates `levels`.
    [[nodiscard]] virtual std::vector<shapes::Box> changesSince(std::uint64_t revision, DrawnLevels& levels,
                                                                const LevelRule& rule) = 0;
    /// Returns whether some sand counts as moving, so that LevelRule may draw it more coarsely than sand at rest.
    [[nodiscard]] virtual bool moves() const { return false; }
    /// Returns the number of updates that changed something.
    [[nodiscard]] virtual std::uint64_t revision() const = 0;
    /// Returns the lowest and the highest height that any sand has ever had.
    [[nodiscard]] virtual shapes::HeightRange heightsEver() const = 0;
    /// Returns the current edge of the sand.
    [[nodiscard]] virtual shapes::SandRim rim() const = 0;

    [[nodiscard]] virtual int chunks() const = 0;
    /// Returns the memory of vertices and indices in GL [byte].
    [[nodiscard]] virtual std::size_t bytes() const = 0;
    /// Returns the number of heights that updates have read, or of vertices and triangles of a TIN. For measurements.
    [[nodiscard]] virtual std::int64_t placesRead() const = 0;
    /// Returns the work so far. A TIN does not count it.
    [[nodiscard]] virtual Work work() const { return {}; }
};

}  // namespace render_node
