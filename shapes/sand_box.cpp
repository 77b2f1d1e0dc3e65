// SPDX-License-Identifier: Apache-2.0
#include "shapes/sand_box.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "shapes/box_outline.hpp"

namespace shapes {
namespace {

constexpr int kQuadsOfRun = 64, kVerticesOfRun = 6 * kQuadsOfRun;

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

SandBox::SandBox(const SandRim& cut, float lowest, double cellSize, sand::Rim rim) : cellSize_(cellSize) {
    float lowestRim = std::numeric_limits<float>::max(), highestRim = std::numeric_limits<float>::lowest();
    for (const auto& line : cut.cuts) {
        for (const glm::vec3& vertex : line) {
            if (vertex.x <= 0 || vertex.y <= 0 || vertex.x >= cut.field.x || vertex.y >= cut.field.y) {
                lowestRim = std::min(lowestRim, vertex.z);
                highestRim = std::max(highestRim, vertex.z);
            }
        }
    }
    if (lowestRim > highestRim) {
        lowestRim = highestRim = lowest;  // no ground reaches the field's edge
    }
    const float length = std::max(cut.field.x, cut.field.y);
    floor_ = lowest - kFloorDepth * length;
    // The boards are a little higher than the sand at the rim, but low enough not to hide mountains.
    top_ = std::min(highestRim + kBoardRise * length, lowestRim + 0.045F * length);
    width_ = double{cut.field.x};
    depth_ = double{cut.field.y};
    hasHoles_ = cut.hasHoles;
    const double thick = double{kBoardThickness} * std::max(width_, depth_);
    bounds_ = {{-thick, -thick, floor_ - thick}, {width_ + thick, depth_ + thick, top_}};
    makeSides(cut);
    makeBoards(cut, rim);
}

bool SandBox::insideRim(const Box& box) const {
    // The outermost quads are lit at their corners, which are half a cell and one cell apart.
    const double edge = 2 * cellSize_;
    return !hasHoles_ && box.low.x > edge && box.low.y > edge && box.high.x < width_ - edge &&
           box.high.y < depth_ - edge;
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

void SandBox::makeSides(const SandRim& cut) {
    sides_.clear();
    runs_.clear();
    const double margin = 0.01 * cellSize_;  // for rounding of GL's floats
    constexpr double kFar = std::numeric_limits<double>::infinity();
    const auto longest = static_cast<float>(kQuadsOfRun * cellSize_);
    glm::vec2 begin(0);  // of the last run
    for (const auto& line : cut.cuts) {
        for (std::size_t i = 0; i + 1 < line.size(); ++i) {
            const glm::vec2 from(line[i]), to(line[i + 1]);
            if (runs_.empty() || runs_.back().vertices == kVerticesOfRun || glm::distance(begin, to) > longest) {
                runs_.push_back({static_cast<int>(sides_.size()), 0, {glm::dvec3(kFar), glm::dvec3(-kFar)}});
                begin = from;
            }
            const float fromTop = std::max(floor_, line[i].z);
            const float toTop = std::max(floor_, line[i + 1].z);
            addQuad(sides_,
                    {glm::vec3(from, floor_), glm::vec3(to, floor_), glm::vec3(to, toTop), glm::vec3(from, fromTop)});
            Run& run = runs_.back();
            run.vertices = static_cast<int>(sides_.size()) - run.firstVertex;
            run.box.low = glm::min(run.box.low, glm::dvec3(glm::min(from, to), floor_) - margin);
            run.box.high = glm::max(run.box.high, glm::dvec3(glm::max(from, to), std::max(fromTop, toTop)) + margin);
        }
    }
    for (const Run& run : runs_) {
        bounds_ = {glm::min(bounds_.low, run.box.low), glm::max(bounds_.high, run.box.high)};
    }
}

void SandBox::makeBoards(const SandRim& cut, sand::Rim rim) {
    const float width = cut.field.x;
    const float depth = cut.field.y;
    const float thick = kBoardThickness * std::max(width, depth);
    if (rim == sand::Rim::closed) {
        addBlock(boards_, {-thick, -thick, floor_}, {width + thick, 0, top_});
        addBlock(boards_, {-thick, depth, floor_}, {width + thick, depth + thick, top_});
        addBlock(boards_, {-thick, 0, floor_}, {0, depth, top_});
        addBlock(boards_, {width, 0, floor_}, {width + thick, depth, top_});
    }
    addBlock(boards_, {-thick, -thick, floor_ - thick}, {width + thick, depth + thick, floor_});
}

}  // namespace shapes
