// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace scene {

/// Triangles over points, counter-clockwise as seen from above.
struct Mesh {
    std::vector<std::array<double, 3>> vertices;          // x east, y north, z up
    std::vector<std::array<std::uint32_t, 3>> triangles;  // indices of vertices, from 0
};

/// Writes a mesh as .ply (binary, little-endian, doubles) or .obj (text). Texts have the shortest decimals from which
/// the same numbers are read again. An existing file is replaced when everything is written. Throws base::InputError
/// for another ending, and if the file cannot be written completely.
void writeMesh(const Mesh& mesh, const std::filesystem::path& file);

/// Returns whether the name is that of a mesh: it ends in .ply or .obj, in small or capital letters.
[[nodiscard]] bool namesMesh(const std::filesystem::path& file);

/// Throws base::InputError unless namesMesh(`file`). Call it before long work.
void checkMeshName(const std::filesystem::path& file);

}  // namespace scene
