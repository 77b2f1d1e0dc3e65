// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "sand/tin/mesh/mesh.hpp"

namespace sand::tin {

/// Volumes of the vertices after a change of the mesh.
struct Remapped {
    struct Share {
        Vertex vertex = kNoNumber;
        std::int64_t star = 0;    // [probe unit²]
        Wide volume = 0;          // [unit / 6 · probe unit²]
        double before = 0;        // height of the previous surface there [unit]
        double bound = 0;         // largest distance of the vertex from `before` [unit]
        std::uint32_t piece = 0;  // equal for all vertices of a piece, and for no others
        bool moves = false;       // whether its sand moves
    };
    std::vector<Share> shares;    // in ascending order of vertices
    std::vector<Vertex> removed;  // vertices that no longer exist
};

/// Makes the sand level in every piece that has a share for which `fits` is false. The volume of the piece is kept
/// exactly. Volumes that integers cannot share are given out one unit each, in the order of the vertices.
///
/// A mean lies between the heights of which it is the mean, and the stars of a piece have the same sum before and after
/// a change. Level sand therefore keeps every limit of heights that the sand before kept.
void levelPieces(Remapped& result, const std::function<bool(const Remapped::Share&)>& fits);

/// Sand by vertex, from before a change of the mesh.
struct SandBefore {
    const std::vector<std::int64_t>&volumes, &stars;
    const std::vector<double>& heights;
    const std::vector<std::uint8_t>& moving;
};

/// Returns the volumes of all vertices of the triangles that changed. Their sum is exactly what it was. A new vertex
/// moves if a vertex of its piece moved before. Result and order depend only on the two meshes and the sand.
[[nodiscard]] Remapped remapVolumes(const Mesh::Difference& difference, const SandBefore& before);

}  // namespace sand::tin
