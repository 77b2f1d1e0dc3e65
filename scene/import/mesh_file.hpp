// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace scene {

/// Triangles over points, counter-clockwise from above.
struct Mesh {
    std::vector<std::array<double, 3>> vertices;          // x east, y north, z up
    std::vector<std::array<std::uint32_t, 3>> triangles;  // of vertices, counted from 0
};

/// Writes a mesh as .ply (binary, little-endian, doubles) or .obj (text, the shortest decimals that are read back as
/// the same numbers); what stood there is replaced when all is written. Throws base::InputError: another ending, a
/// file that cannot be written whole.
void writeMesh(const Mesh& mesh, const std::filesystem::path& file);

/// Whether the name asks for a mesh: .ply or .obj, in small letters or large ones.
[[nodiscard]] bool namesMesh(const std::filesystem::path& file);

/// Throws base::InputError unless it does: asked before long work.
void checkMeshName(const std::filesystem::path& file);

}  // namespace scene
