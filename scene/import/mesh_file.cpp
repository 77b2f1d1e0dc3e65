// SPDX-License-Identifier: Apache-2.0
#include "scene/import/mesh_file.hpp"

#include <fmt/format.h>

#include <iterator>
#include <string>

#include "base/byte_stream.hpp"
#include "base/input_error.hpp"
#include "base/text.hpp"
#include "host/whole_file.hpp"

namespace scene {
namespace {

constexpr std::size_t kReadPiece = 1 << 20;  // [byte], approximate size of a write

/// Writes the elements in pieces. `append` adds an element to a piece.
template <class Elements, class Append>
void writeAll(const Elements& elements, std::ostream& stream, Append append) {
    std::string piece;
    const auto flush = [&] {
        stream.write(piece.data(), static_cast<std::streamsize>(piece.size()));
        piece.clear();
    };
    for (const auto& element : elements) {
        append(element, piece);
        if (piece.size() > kReadPiece) {
            flush();
        }
    }
    flush();
}

template <class Number>
void appendBytes(Number number, std::string& bytes) {
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);  // every host is little-endian
}

void writePly(const Mesh& mesh, std::ostream& stream) {
    stream << fmt::format(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty double x\nproperty double y\n"
        "property double z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
        mesh.vertices.size(), mesh.triangles.size());
    writeAll(mesh.vertices, stream, [](const auto& vertex, std::string& bytes) {
        for (const double number : vertex) {
            appendBytes(number, bytes);
        }
    });
    writeAll(mesh.triangles, stream, [](const auto& triangle, std::string& bytes) {
        bytes.push_back(3);
        for (const std::uint32_t corner : triangle) {
            appendBytes(corner, bytes);
        }
    });
}

void writeObj(const Mesh& mesh, std::ostream& stream) {
    writeAll(mesh.vertices, stream, [](const auto& vertex, std::string& text) {
        fmt::format_to(std::back_inserter(text), "v {} {} {}\n", vertex[0], vertex[1], vertex[2]);
    });
    writeAll(mesh.triangles, stream, [](const auto& triangle, std::string& text) {
        fmt::format_to(std::back_inserter(text), "f {} {} {}\n", triangle[0] + 1, triangle[1] + 1, triangle[2] + 1);
    });
}

}  // namespace

bool namesMesh(const std::filesystem::path& file) {
    const std::string ending = base::endingOf(file);
    return ending == ".ply" || ending == ".obj";
}

void checkMeshName(const std::filesystem::path& file) {
    if (!namesMesh(file)) {
        throw base::InputError(file.string() + ": a mesh is written as .ply or .obj");
    }
}

void writeMesh(const Mesh& mesh, const std::filesystem::path& file) {
    checkMeshName(file);
    host::WholeFile whole(file);
    if (base::endingOf(file) == ".ply") {
        writePly(mesh, whole.stream());
    } else {
        writeObj(mesh, whole.stream());
    }
    whole.keep();
}

}  // namespace scene
