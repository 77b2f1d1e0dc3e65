// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "sand/tin/mesh/mesh.hpp"

/// Checks of a mesh that do not depend on how it was made. They share no code with the mesh.
namespace mesh_checks {

using sand::tin::LatticePoint;
using sand::tin::Mesh;
using sand::tin::Triangles;
using sand::tin::Vertex;
using LatticeTriangle = std::array<LatticePoint, 3>;  // counter-clockwise from the smallest place

/// Returns the first fault of a mesh, or an empty string. Checks areas, neighbours and Euler's formula. The circle of
/// every unconstrained edge must be empty; if four places are on it, the diagonal must begin at the first place. All
/// arithmetic is in exact integers.
[[nodiscard]] std::string whatIsWrong(const Mesh& mesh);

[[nodiscard]] std::set<LatticeTriangle> trianglesOf(const Mesh& mesh);
[[nodiscard]] std::set<std::pair<LatticePoint, LatticePoint>> constraintsOf(const Mesh& mesh);
[[nodiscard]] std::vector<std::optional<LatticePoint>> placesOf(const Mesh& mesh);
[[nodiscard]] Mesh restored(const Mesh& mesh);
/// Returns a mesh with the same vertices and constraints, inserted in a random order.
[[nodiscard]] Mesh madeInAnotherOrder(const Mesh& mesh, std::mt19937& random);

[[nodiscard]] std::vector<Vertex> livingVertices(const Mesh& mesh);
/// Inserts, removes, constrains or releases a random vertex or edge. Returns a description of the edit, for failure
/// messages.
std::string editAtRandom(Mesh& mesh, std::mt19937& random, int most /* rough limit of vertices */);

}  // namespace mesh_checks
