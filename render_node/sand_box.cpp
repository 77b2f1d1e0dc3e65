// SPDX-License-Identifier: Apache-2.0
#include "render_node/sand_box.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace render_node {
namespace {

constexpr float kThickness = 0.015F;  // of boards and floor [longer side of the field]
constexpr int kQuadsOfRun = 64;

/// Appends a quad a-b-c-d, counter-clockwise from outside; the grain of wood runs along its longest axis.
void addQuad(std::vector<SolidVertex>& out, const std::array<glm::vec3, 4>& corners) {
    const glm::vec3 first = corners[1] - corners[0];
    const glm::vec3 second = corners[3] - corners[0];
    const glm::vec3 normal = glm::normalize(glm::cross(first, second));
    const bool firstLonger = glm::length(first) >= glm::length(second);
    const glm::vec3 grain = glm::normalize(firstLonger ? first : second);
    const glm::vec3 across = glm::cross(normal, grain);
    for (const std::size_t corner : {0U, 1U, 2U, 0U, 2U, 3U}) {
        const glm::vec3& at = corners[corner];
        out.push_back({at, normal, {glm::dot(at, grain), glm::dot(at, across)}});
    }
}

void addBlock(std::vector<SolidVertex>& out, const glm::vec3& low, const glm::vec3& high) {
    const auto at = [&](int x, int y, int z) {
        return glm::vec3(x == 0 ? low.x : high.x, y == 0 ? low.y : high.y, z == 0 ? low.z : high.z);
    };
    addQuad(out, {at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1)});
    addQuad(out, {at(0, 1, 0), at(1, 1, 0), at(1, 0, 0), at(0, 0, 0)});
    addQuad(out, {at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1)});
    addQuad(out, {at(1, 1, 0), at(0, 1, 0), at(0, 1, 1), at(1, 1, 1)});
    addQuad(out, {at(0, 1, 0), at(0, 0, 0), at(0, 0, 1), at(0, 1, 1)});
    addQuad(out, {at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1)});
}

}  // namespace

SandBox::SandBox(const SandSurface& surface, sand::Rim rim) {
    float lowest = surface.height(0, 0);
    float lowestRim = lowest;
    float highestRim = lowest;
    for (int row = 0; row < surface.rows(); ++row) {
        const bool edgeRow = row == 0 || row == surface.rows() - 1;
        for (int column = 0; column < surface.columns(); ++column) {
            const float height = surface.height(column, row);
            lowest = std::min(lowest, height);
            if (edgeRow || column == 0 || column == surface.columns() - 1) {
                lowestRim = std::min(lowestRim, height);
                highestRim = std::max(highestRim, height);
            }
        }
    }
    const float length = std::max(surface.east(surface.columns() + 1), surface.north(surface.rows() + 1));
    floor_ = lowest - 0.06F * length;
    // Boards as high as the sand at the rim and a little more; but mountains must not vanish behind them.
    top_ = std::min(highestRim + 0.006F * length, lowestRim + 0.045F * length);
    cellSize_ = double{surface.cellSize()};
    width_ = double{surface.east(surface.columns() + 1)};
    depth_ = double{surface.north(surface.rows() + 1)};
    const double thick = kThickness * std::max(width_, depth_);
    bounds_ = {{-thick, -thick, floor_ - thick}, {width_ + thick, depth_ + thick, top_}};
    makeSides(surface);
    makeBoards(surface, rim);
}

void SandBox::update(const SandSurface& surface, const sand::Rect& cells) {
    if (!cells.empty() &&
        (cells.x0 <= 0 || cells.y0 <= 0 || cells.x1 >= surface.columns() || cells.y1 >= surface.rows())) {
        makeSides(surface);
    }
}

bool SandBox::insideRim(const Box& box) const {
    // The quads of the rim are lit at their corners, half a cell and a cell apart.
    const double edge = 2 * cellSize_;
    return box.low.x > edge && box.low.y > edge && box.high.x < width_ - edge && box.high.y < depth_ - edge;
}

Box SandBox::withSides(const Box& box) const {
    if (insideRim(box)) {
        return box;
    }
    Box grown = box;
    grown.low.z = std::min(grown.low.z, bounds_.low.z);
    grown.high.z = std::max(grown.high.z, bounds_.high.z);
    return grown;
}

void SandBox::drawSides(const glm::dmat4& sceneToClip, bool culling) const {
    for (const Run& run : runs_) {
        if (!culling || inFrustum(run.box, sceneToClip)) {
            sides_.draw(run.firstVertex, run.vertices);
        }
    }
}

void SandBox::makeSides(const SandSurface& surface) {
    std::vector<SolidVertex> triangles;
    runs_.clear();
    const double margin = 0.01 * cellSize_;  // for what GL's floats may round
    // From one vertex of the rim to the next, with the outside on the right hand.
    const auto strip = [&](int column, int row, int nextColumn, int nextRow) {
        const glm::vec2 from(surface.east(column), surface.north(row));
        const glm::vec2 to(surface.east(nextColumn), surface.north(nextRow));
        const float fromTop = std::max(floor_, surface.height(column - 1, row - 1));
        const float toTop = std::max(floor_, surface.height(nextColumn - 1, nextRow - 1));
        addQuad(triangles,
                {glm::vec3(from, floor_), glm::vec3(to, floor_), glm::vec3(to, toTop), glm::vec3(from, fromTop)});
        Run& run = runs_.back();
        run.vertices = static_cast<GLsizei>(triangles.size()) - run.firstVertex;
        run.box.low = glm::min(run.box.low, glm::dvec3(glm::min(from, to), floor_) - margin);
        run.box.high = glm::max(run.box.high, glm::dvec3(glm::max(from, to), std::max(fromTop, toTop)) + margin);
    };
    constexpr double kFar = std::numeric_limits<double>::infinity();
    const auto side = [&](int quads, const auto& quad) {
        for (int i = 0; i < quads; ++i) {
            if (i % kQuadsOfRun == 0) {
                runs_.push_back({static_cast<GLint>(triangles.size()), 0, {glm::dvec3(kFar), glm::dvec3(-kFar)}});
            }
            quad(i);
        }
    };
    const int lastColumn = surface.columns() + 1;
    const int lastRow = surface.rows() + 1;
    side(lastColumn, [&](int column) { strip(column, 0, column + 1, 0); });
    side(lastColumn, [&](int column) { strip(column + 1, lastRow, column, lastRow); });
    side(lastRow, [&](int row) { strip(0, row + 1, 0, row); });
    side(lastRow, [&](int row) { strip(lastColumn, row, lastColumn, row + 1); });
    for (const Run& run : runs_) {
        bounds_ = {glm::min(bounds_.low, run.box.low), glm::max(bounds_.high, run.box.high)};
    }
    sides_.set(triangles);
}

void SandBox::makeBoards(const SandSurface& surface, sand::Rim rim) {
    const float width = surface.east(surface.columns() + 1);
    const float depth = surface.north(surface.rows() + 1);
    std::vector<SolidVertex> triangles;
    const float thick = kThickness * std::max(width, depth);
    if (rim == sand::Rim::closed) {
        addBlock(triangles, {-thick, -thick, floor_}, {width + thick, 0, top_});
        addBlock(triangles, {-thick, depth, floor_}, {width + thick, depth + thick, top_});
        addBlock(triangles, {-thick, 0, floor_}, {0, depth, top_});
        addBlock(triangles, {width, 0, floor_}, {width + thick, depth, top_});
    }
    addBlock(triangles, {-thick, -thick, floor_ - thick}, {width + thick, depth + thick, floor_});
    boards_.set(triangles);
}

}  // namespace render_node
