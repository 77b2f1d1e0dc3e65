// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <vector>

#include "sand/tin/mesh/mesh.hpp"

namespace sand::tin {

/// Volumes of the vertices after a change of the mesh.
struct Remapped {
    struct Share {
        Vertex vertex = kNobody;
        std::int64_t star = 0;  // [probe unit²]
        Wide volume = 0;        // [unit / 6 · probe unit²]
        double before = 0;      // height of the previous surface there [unit]
        double bound = 0;       // largest distance of the vertex from `before` [unit]
    };
    std::vector<Share> shares;  // in ascending order of vertices
    std::vector<Vertex> died;   // vertices that no longer exist
};

/// Returns the volumes of all vertices of the triangles that changed. Their sum is exactly what it was. `volumes`,
/// `stars` and `heights` are indexed by vertex and are those from before the change. Result and order depend only on
/// the two meshes and the sand.
[[nodiscard]] Remapped remapVolumes(const Mesh::Difference& difference, const std::vector<std::int64_t>& volumes,
                                    const std::vector<std::int64_t>& stars, const std::vector<double>& heights);

}  // namespace sand::tin
