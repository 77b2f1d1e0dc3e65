// SPDX-License-Identifier: Apache-2.0
#include "render_node/tool_mesh.hpp"

#include <array>

namespace render_node {
namespace {

using Triangle = std::array<glm::vec3, 3>;

std::vector<Triangle> icosahedron() {
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
    constexpr std::array<std::array<std::size_t, 3>, 20> kFaces{
        {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
         {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
         {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
    std::vector<Triangle> triangles;
    triangles.reserve(kFaces.size());
    for (const auto& face : kFaces) {
        triangles.push_back(
            {glm::normalize(corners[face[0]]), glm::normalize(corners[face[1]]), glm::normalize(corners[face[2]])});
    }
    return triangles;
}

}  // namespace

std::vector<SolidVertex> makeSphere(int splits) {
    std::vector<Triangle> triangles = icosahedron();
    for (int split = 0; split < splits; ++split) {
        std::vector<Triangle> finer;
        for (const auto& [a, b, c] : triangles) {
            const glm::vec3 ab = glm::normalize(a + b);
            const glm::vec3 bc = glm::normalize(b + c);
            const glm::vec3 ca = glm::normalize(c + a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        triangles = std::move(finer);
    }
    std::vector<SolidVertex> vertices;
    for (const Triangle& triangle : triangles) {
        for (const glm::vec3& corner : triangle) {
            vertices.push_back({corner, corner, {}});
        }
    }
    return vertices;
}

}  // namespace render_node
