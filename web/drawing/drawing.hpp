// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "shapes/model/surface_parts.hpp"
#include "shapes/sand_box.hpp"
#include "shapes/tool/mesh.hpp"
#include "web/drawing/piece.hpp"
#include "web/replica/step_source.hpp"

namespace web {

/// The drawing of a session for the page: the wall's meshes, and the values of its shaders' uniforms by their names.
///
/// take() finds the differences from the drawing before. next() makes them piece by piece, so that a large field never
/// needs room for all of its vertices at once.
class Drawing {
public:
    /// `source` must outlive this object.
    explicit Drawing(StepSource& source);

    /// Returns whether the sand has a height for each cell.
    [[nodiscard]] bool hasHeights() const;
    /// Takes the present sand and tool. All pieces of the sand before must have been taken.
    void take();
    /// Fills `piece` with the next arrays. Returns false behind the last piece.
    [[nodiscard]] bool next(Piece& piece);

private:
    void addStart();
    void addSand(const shapes::SurfaceParts::Change& change);
    void addHeights();
    void addTool();

    StepSource& source_;
    std::unique_ptr<shapes::SurfaceParts> sand_;
    std::optional<shapes::SandBox> box_;    // made of the first sand
    std::optional<shapes::ToolForm> form_;  // of the tool that the page has
    std::vector<std::function<void(Piece&)>> pieces_;
    std::size_t next_ = 0;
};

}  // namespace web
