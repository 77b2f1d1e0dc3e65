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

/// What a mesh must be, told apart from how it came to be so: nothing here is shared with what is tested.
namespace mesh_checks {

using sand::tin::Mesh;
using sand::tin::Place;
using sand::tin::Triangles;
using sand::tin::Vertex;
using PlaceTriangle = std::array<Place, 3>;  // counter-clockwise from the smallest

/// What is wrong with it first, or nothing: areas, neighbours, Euler's formula, the empty circle of every edge that is
/// no constraint, and where circles are not empty the diagonal out from the first place. All in exact integers.
[[nodiscard]] std::string whatIsWrong(const Mesh& mesh);

[[nodiscard]] std::set<PlaceTriangle> trianglesOf(const Mesh& mesh);
[[nodiscard]] std::set<std::pair<Place, Place>> constraintsOf(const Mesh& mesh);
[[nodiscard]] std::vector<std::optional<Place>> placesOf(const Mesh& mesh);
[[nodiscard]] Mesh restored(const Mesh& mesh);
/// The same vertices and constraints, come to by another way.
[[nodiscard]] Mesh madeInAnotherOrder(const Mesh& mesh, std::mt19937& random);

[[nodiscard]] std::vector<Vertex> livingVertices(const Mesh& mesh);
/// Inserts, removes, constrains or releases something; what it did, for whoever must find out why.
std::string editAtRandom(Mesh& mesh, std::mt19937& random, int most /* vertices, about */);

}  // namespace mesh_checks
