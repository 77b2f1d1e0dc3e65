// SPDX-License-Identifier: Apache-2.0
#include "shapes/tool/mesh.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "sand/model/tool_shape.hpp"

namespace shapes {
namespace {

using Corners = std::array<glm::vec3, 3>;

std::vector<Corners> icosahedron() {
    constexpr float kGolden = 1.61803399F;
    const std::array<glm::vec3, 12> corners{{{-1, kGolden, 0},
                                             {1, kGolden, 0},
                                             {-1, -kGolden, 0},
                                             {1, -kGolden, 0},
                                             {0, -1, kGolden},
                                             {0, 1, kGolden},
                                             {0, -1, -kGolden},
                                             {0, 1, -kGolden},
                                             {kGolden, 0, -1},
                                             {kGolden, 0, 1},
                                             {-kGolden, 0, -1},
                                             {-kGolden, 0, 1}}};
    constexpr std::array<std::array<std::size_t, 3>, 20> kIcosahedron{
        {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
         {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
         {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
    std::vector<Corners> triangles;
    triangles.reserve(kIcosahedron.size());
    for (const auto& face : kIcosahedron) {
        triangles.push_back(
            {glm::normalize(corners[face[0]]), glm::normalize(corners[face[1]]), glm::normalize(corners[face[2]])});
    }
    return triangles;
}

constexpr float kPlate = 0.25F;       // [radius], thickness of flat tools and soles
constexpr float kHandle = 0.07F;      // [radius], radius of the rod from the plate to the centre
constexpr float kKnob = 0.16F;        // [radius], radius of the ball at the end of the rod
constexpr int kAround = 48, kIn = 4;  // parts of an ellipse, and rings of the bowl below it

glm::vec2 onCircle(int i) {
    const double turn = 2 * std::numbers::pi * i / kAround;
    return {std::cos(turn), std::sin(turn)};
}

/// Triangles in the tool's own axes.
struct Solid {
    std::vector<SolidVertex> vertices{};

    void add(const glm::vec3& position, const glm::vec3& normal) { vertices.push_back({position, normal, {}}); }
    /// Adds a quad with its corners counter-clockwise, seen from outside.
    void quad(const std::array<glm::vec3, 4>& corners, const std::array<glm::vec3, 4>& normals) {
        for (const std::size_t i : {0U, 1U, 2U, 0U, 2U, 3U}) {
            add(corners[i], normals[i]);
        }
    }
    void flat(const std::array<glm::vec3, 4>& corners) {
        const glm::vec3 normal = glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
        quad(corners, {normal, normal, normal, normal});
    }
    void box(const glm::vec3& low, const glm::vec3& high) {
        const auto corner = [&](int i) {
            return glm::vec3((i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y,
                             (i & 4) != 0 ? high.z : low.z);
        };
        for (const auto& [a, b, c, d] : {std::array{0, 2, 3, 1}, std::array{4, 5, 7, 6}, std::array{0, 1, 5, 4},
                                         std::array{2, 6, 7, 3}, std::array{0, 4, 6, 2}, std::array{1, 3, 7, 5}}) {
            flat({corner(a), corner(b), corner(c), corner(d)});
        }
    }
    /// Adds an upright elliptic plate with a bowl below it. `middle` and `half` are in radii.
    void plate(const glm::vec2& middle, const glm::vec2& half, float lift, float bulge, float top) {
        const auto at = [&](int i, float share, float z) { return glm::vec3(middle + share * half * onCircle(i), z); };
        const auto below = [&](float share) { return lift - 1 + bulge * share * share; };
        const auto down = [&](int i, float share) {
            return glm::normalize(glm::vec3(2 * bulge * share * onCircle(i) / half, -1));
        };
        for (int i = 0; i < kAround; ++i) {
            const glm::vec3 side = glm::normalize(glm::vec3(onCircle(i) / half, 0));
            const glm::vec3 next = glm::normalize(glm::vec3(onCircle(i + 1) / half, 0));
            quad({at(i, 1, below(1)), at(i + 1, 1, below(1)), at(i + 1, 1, top), at(i, 1, top)},
                 {side, next, next, side});
            flat({at(i, 1, top), at(i + 1, 1, top), glm::vec3(middle, top), glm::vec3(middle, top)});
            for (int ring = 0; ring < kIn; ++ring) {
                const float in = static_cast<float>(ring) / kIn, out = static_cast<float>(ring + 1) / kIn;
                quad({at(i, out, below(out)), at(i, in, below(in)), at(i + 1, in, below(in)),
                      at(i + 1, out, below(out))},
                     {down(i, out), down(i, in), down(i + 1, in), down(i + 1, out)});
            }
        }
    }
    void handle() {
        plate({0, 0}, {kHandle, kHandle}, kPlate / 2, 0, 0);
        for (const SolidVertex& vertex : makeSphere(2)) {
            add(kKnob * vertex.position, vertex.normal);
        }
    }
};

void addEllipsoid(Solid& solid, float width) {
    const glm::vec3 squeezed(1, width, 1);
    for (const SolidVertex& vertex : makeSphere(3)) {
        solid.add(squeezed * vertex.position, glm::normalize(vertex.normal / squeezed));
    }
}

void addSole(Solid& solid, sand::ToolKind kind, float width) {
    for (const sand::SolePiece& piece : sand::solePieces(kind)) {
        solid.plate(glm::dvec2(piece.along, double{width} * piece.across),
                    glm::dvec2(piece.halfLength, double{width} * piece.halfWidth), static_cast<float>(piece.lift),
                    static_cast<float>(piece.bulge), kPlate - 1);
    }
}

/// The compiler names a kind that is missing here.
Solid solidOf(sand::ToolKind kind, float width) {
    using enum sand::ToolKind;
    Solid solid;
    switch (kind) {
        case sphere:
            return {makeSphere(3)};
        case ellipsoid:
            addEllipsoid(solid, width);
            return solid;
        case rectangle:
            solid.box({-1, -width, -1}, {1, width, kPlate - 1});
            break;
        case circle:
        case ellipse:
            solid.plate({0, 0}, {1, width}, 0, 0, kPlate - 1);
            break;
        case footprint:
            addSole(solid, kind, width);
            break;
    }
    solid.handle();
    return solid;
}

float widthOf(const sand::Tool& tool) {
    return sand::isRound(tool.kind) || tool.radius == 0
               ? 1
               : static_cast<float>(tool.halfWidth) / static_cast<float>(tool.radius);
}

}  // namespace

std::vector<SolidVertex> makeTool(const sand::Tool& tool) {
    std::vector<SolidVertex> vertices = solidOf(tool.kind, widthOf(tool)).vertices;
    if (sand::isRound(tool.kind)) {
        return vertices;
    }
    const glm::vec2 along = glm::normalize(glm::vec2(tool.heading.x, tool.heading.y));
    const glm::vec2 across = glm::vec2(-along.y, along.x) * (tool.heading.mirrored ? -1.0F : 1.0F);
    for (SolidVertex& vertex : vertices) {
        for (glm::vec3* vector : {&vertex.position, &vertex.normal}) {
            *vector = glm::vec3(vector->x * along + vector->y * across, vector->z);
        }
    }
    for (std::size_t i = 0; tool.heading.mirrored && i + 2 < vertices.size(); i += 3) {
        std::swap(vertices[i + 1], vertices[i + 2]);
    }
    return vertices;
}

Box boxOfTool(const sand::Tool& tool) {
    // A hundredth more, for rounding of GL's floats.
    if (tool.kind == sand::ToolKind::sphere || tool.kind == sand::ToolKind::ellipsoid) {
        return {glm::dvec3(-1.01), glm::dvec3(1.01)};
    }
    const double corner = tool.kind == sand::ToolKind::rectangle ? std::hypot(1.0, double{widthOf(tool)}) : 1.0;
    const double wide = 1.01 * corner;
    return {{-wide, -wide, -1.01}, {wide, wide, 1.01 * double{kKnob}}};
}

Box bodyOf(const DrawnTool& drawn) {
    const Box box = boxOfTool(drawn.tool);
    const glm::dvec3 place(drawn.place);
    return {place + double{drawn.radius} * box.low, place + double{drawn.radius} * box.high};
}

ToolForm formOf(const sand::Tool& tool) {
    return {tool.kind, double{widthOf(tool)}, sand::isRound(tool.kind) ? sand::Heading{} : tool.heading};
}

std::vector<SolidVertex> makeSphere(int splits) {
    std::vector<Corners> triangles = icosahedron();
    for (int split = 0; split < splits; ++split) {
        std::vector<Corners> finer;
        for (const auto& [a, b, c] : triangles) {
            const glm::vec3 ab = glm::normalize(a + b);
            const glm::vec3 bc = glm::normalize(b + c);
            const glm::vec3 ca = glm::normalize(c + a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        triangles = std::move(finer);
    }
    std::vector<SolidVertex> vertices;
    for (const Corners& triangle : triangles) {
        for (const glm::vec3& corner : triangle) {
            vertices.push_back({corner, corner, {}});
        }
    }
    return vertices;
}

}  // namespace shapes
