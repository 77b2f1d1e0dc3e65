// SPDX-License-Identifier: Apache-2.0
#include "web/drawing/drawing.hpp"

#include <algorithm>
#include <variant>

#include "shapes/grid/parts.hpp"
#include "shapes/model/colours.hpp"
#include "shapes/model/grain.hpp"
#include "shapes/tin/parts.hpp"
#include "shapes/tool/light.hpp"

namespace web {
namespace {

std::unique_ptr<shapes::SurfaceParts> partsOf(const sand::SurfaceData& data, double cellSize) {
    if (const auto* const grid = std::get_if<sand::GridData>(&data)) {
        return std::make_unique<shapes::GridParts>(*grid);
    }
    return std::make_unique<shapes::TinParts>(cellSize);
}

glm::vec3 toVector(const std::vector<double>& numbers) { return glm::dvec3(numbers[0], numbers[1], numbers[2]); }

template <class Vector>
std::vector<float> floatsOf(const Vector& vector) {
    return {&vector[0], &vector[0] + Vector::length()};
}
std::vector<float> floatsOf(const glm::mat3& matrix) { return {&matrix[0][0], &matrix[0][0] + 9}; }

/// Returns the numbers of the vertices: place, normal, and the place along the grain of wood.
std::vector<float> floatsOf(const std::vector<shapes::SolidVertex>& triangles) {
    std::vector<float> numbers;
    numbers.reserve(8 * triangles.size());
    for (const auto& [at, normal, along] : triangles) {
        numbers.insert(numbers.end(), {at.x, at.y, at.z, normal.x, normal.y, normal.z, along.x, along.y});
    }
    return numbers;
}

/// Returns the texels of all levels, from the finest one on.
std::vector<std::uint8_t> grainUnder(const glm::vec3& sun) {
    std::vector<std::uint8_t> all;
    for (const std::vector<std::uint8_t>& level : shapes::grainLevels(glm::vec2(sun))) {
        all.insert(all.end(), level.begin(), level.end());
    }
    return all;
}

glm::vec3 sunOf(const scene::Scene& scene) { return glm::normalize(toVector(scene.look.sunDirection)); }

}  // namespace

Drawing::Drawing(StepSource& source)
    : source_(source), sand_(partsOf(source.replica().surface().data(), source.replica().cellSize())) {}

bool Drawing::hasHeights() const { return std::holds_alternative<sand::GridData>(source_.replica().surface().data()); }

void Drawing::take() {
    pieces_.clear();
    next_ = 0;
    const shapes::SurfaceParts::Change change = sand_->take(source_.replica().surface().data());
    if (!box_) {
        const auto cell = double{static_cast<float>(source_.replica().cellSize())};
        box_.emplace(sand_->rim(), sand_->lowest(), cell, source_.scene().rules.rim);
        addStart();
    } else if (change.rim) {
        box_->update(sand_->rim());
    }
    addSand(change);
    if (change.rim) {
        pieces_.emplace_back([this](Piece& piece) { piece.add("sides", floatsOf(box_->sides())); });
    }
    addHeights();
    addTool();
}

bool Drawing::next(Piece& piece) {
    piece.arrays.clear();
    if (next_ == pieces_.size()) {
        return false;
    }
    pieces_[next_++](piece);
    return true;
}

/// Adds what never changes in a session.
void Drawing::addStart() {
    pieces_.emplace_back([this](Piece& piece) {
        const glm::vec3 sun = sunOf(source_.scene());
        const shapes::PlaceUniforms places = sand_->places();
        piece.add("background", floatsOf(shapes::encoded(toVector(source_.scene().look.backgroundColour))));
        piece.add("grain", grainUnder(sun));
        piece.add("grainPeriod", static_cast<float>(shapes::kGrainSide * shapes::kGrainTexel));
        piece.add("boards", floatsOf(box_->boards()));
        piece.add("uSun", floatsOf(sun));
        piece.add("uCell", places.cell);
        piece.add("uCells", floatsOf(places.cells));
        piece.add("uFirst", places.first);
    });
}

void Drawing::addSand(const shapes::SurfaceParts::Change& change) {
    if (change.whole) {
        pieces_.emplace_back([this](Piece& piece) {
            piece.add("vertices", std::vector<std::uint32_t>{static_cast<std::uint32_t>(sand_->vertices())});
        });
    }
    for (const int number : change.parts) {
        pieces_.emplace_back([this, number, whole = change.whole](Piece& piece) {
            shapes::SurfacePart part = sand_->part(number);
            piece.add("first", std::vector<std::uint32_t>{part.first});
            piece.add("aHeight", std::move(part.heights));
            piece.add("aGrid", std::move(part.places));
            piece.add("aNormal", std::move(part.normals));
            piece.add("aShade", std::move(part.shades));
            if (whole) {
                piece.add("triangles", sand_->triangles(number));
            }
        });
    }
}

/// Adds the exact heights of a grid, which a person may save.
void Drawing::addHeights() {
    pieces_.emplace_back([this](Piece& piece) {
        const sand::SurfaceData data = source_.replica().surface().data();
        if (const auto* const grid = std::get_if<sand::GridData>(&data)) {
            std::vector<std::int32_t> heights;
            for (int y = 0; y < grid->field.rows(); ++y) {
                heights.insert(heights.end(), grid->field.row(y), grid->field.row(y) + grid->field.columns());
            }
            piece.add("heights", std::move(heights));
        }
    });
}

void Drawing::addTool() {
    pieces_.emplace_back([this](Piece& piece) {
        const sand::Replica& replica = source_.replica();
        const scene::Scene& scene = source_.scene();
        const auto drawn =
            shapes::DrawnTool::at(replica.tool(), replica.probe(), replica.engaged(), replica.cellSize());
        const bool shown = drawn.radius > 0;
        const shapes::ToolUniforms light = shown ? uniformsOf(drawn, sunOf(scene)) : shapes::ToolUniforms();
        const double humidity = source_.humidity();
        piece.add("uSand", floatsOf(shapes::wetAlbedo(toVector(scene.look.sandColour), humidity)));
        piece.add("uWet", static_cast<float>(humidity));
        piece.add("ball", drawn.isBall() ? 1.0F : 0.0F);
        piece.add("uTool", floatsOf(light.tool));
        piece.add("uToolSpace", floatsOf(light.space));
        piece.add("uToolSun", floatsOf(light.sun));
        piece.add("uToolStep", light.sunStep);
        piece.add("uModel", floatsOf(glm::vec4(drawn.place, drawn.radius)));
        piece.add("uEngaged", drawn.engaged ? 1.0F : 0.0F);
        if (shown && form_ != shapes::formOf(drawn.tool)) {
            form_ = shapes::formOf(drawn.tool);
            piece.add("tool", floatsOf(shapes::makeTool(drawn.tool)));
        }
    });
}

}  // namespace web
