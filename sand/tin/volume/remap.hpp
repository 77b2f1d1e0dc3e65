// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <vector>

#include "sand/tin/mesh/mesh.hpp"

namespace sand::tin {

/// What becomes of the sand where a mesh changed.
struct Remapped {
    struct Share {
        Vertex vertex = kNobody;
        std::int64_t star = 0;  // [probe unit²]
        Wide volume = 0;        // [unit / 6 · probe unit²]
        double before = 0;      // height of the old surface there [unit]
        double bound = 0;       // of how far from it the vertex is put [unit]
    };
    std::vector<Share> shares;  // by number
    std::vector<Vertex> died;
};

/// The volumes of all vertices of what changed, whose sum is exactly what it was; arguments by vertex, as before.
/// Result and order are functions of the two meshes and the sand.
[[nodiscard]] Remapped remapVolumes(const Mesh::Difference& difference, const std::vector<std::int64_t>& volumes,
                                    const std::vector<std::int64_t>& stars, const std::vector<double>& heights);

}  // namespace sand::tin
