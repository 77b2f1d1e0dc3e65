// SPDX-License-Identifier: Apache-2.0
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

#include "sand/tin/volume/vertex_sand.hpp"

namespace sand::tin {
namespace {

using base::FormatError;

constexpr std::size_t kEdgesPerVertex = 3;  // a mesh of n vertices has fewer than 3 n edges

std::size_t livingEnd(const std::vector<LatticePoint>& places) {
    std::size_t end = places.size();
    while (end > 0 && places[end - 1] == VertexSandParts::kNowhere) {
        --end;
    }
    return end;
}

/// Room for the rounding of sweeps, whose sand is the only one that no check holds within kMostSand. Both together are
/// below 2^62.
constexpr std::int64_t kRounding = 10'000'000'000'000'000;

std::int32_t getCoordinate(std::uint64_t value) {
    if (value > static_cast<std::uint64_t>(std::numeric_limits<std::int32_t>::max())) {
        throw FormatError("a vertex outside every field");
    }
    return static_cast<std::int32_t>(value);
}

/// Reads a number of entries. Throws if so many entries of at least `bytesEach` bytes do not fit in the rest.
std::size_t getCount(base::ByteReader& reader, std::size_t bytesEach) {
    const std::uint64_t count = reader.getVarint();
    if (count > reader.rest().size() / bytesEach) {
        throw FormatError("a TIN cut short: " + std::to_string(count) + " entries in " +
                          std::to_string(reader.rest().size()) + " bytes");
    }
    return static_cast<std::size_t>(count);
}

std::vector<std::pair<Vertex, Vertex>> getConstraints(base::ByteReader& reader, std::size_t vertices) {
    std::vector<std::pair<Vertex, Vertex>> constraints;
    const std::size_t count = getCount(reader, 2);
    if (count > kEdgesPerVertex * vertices) {
        throw FormatError("a TIN with more constraints than edges");
    }
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint64_t a = reader.getVarint();
        const std::uint64_t b = reader.getVarint();
        if (a >= b || b >= vertices) {
            throw FormatError("a constraint with vertices out of order or out of range");
        }
        constraints.emplace_back(static_cast<Vertex>(a), static_cast<Vertex>(b));
        if (i > 0 && constraints[i] <= constraints[i - 1]) {
            throw FormatError("constraints out of order");
        }
    }
    return constraints;
}

}  // namespace

VertexSandParts VertexSand::parts() const {
    const Triangles& mesh = triangles();
    VertexSandParts parts{mesh.width, mesh.depth, mesh.places, volumes_, moving_, mesh_.constraints(), mesh_.holes()};
    for (std::size_t i = 0; i < parts.places.size(); ++i) {
        if (mesh.triangleAt[i] == kNoNumber) {
            parts.places[i] = VertexSandParts::kNowhere;
        }
    }
    return parts;
}

void VertexSandParts::encode(base::ByteWriter& writer) const {
    writer.put(width);
    writer.put(depth);
    // Free numbers after the last living vertex depend on history only, so that they are left out.
    const std::size_t count = livingEnd(places);
    writer.putVarint(count);
    for (std::size_t i = 0; i < count; ++i) {
        if (places[i] == kNowhere) {
            writer.putVarint(0);
            continue;
        }
        writer.putVarint(2 * static_cast<std::uint64_t>(places[i].x) + moving[i] + 1);
        writer.putVarint(static_cast<std::uint64_t>(places[i].y));
        writer.putSigned(volumes[i]);
    }
    writer.putVarint(constraints.size());
    for (const auto& [a, b] : constraints) {
        writer.putVarint(static_cast<std::uint64_t>(a));
        writer.putVarint(static_cast<std::uint64_t>(b));
    }
}

std::uint64_t VertexSand::mostBytes(std::size_t most) {
    // Twice a coordinate is at most 2^23 + 2, which takes 4 bytes, a volume 10 and a vertex of a constraint 5. The rest
    // is for width, depth and the two counts.
    constexpr std::uint64_t kVertex = 4 + 4 + 10, kConstraint = 5 + 5, kAround = 4 + 4 + 10 + 10;
    return most * (kVertex + kEdgesPerVertex * kConstraint) + kAround;
}

VertexSand VertexSand::decode(base::ByteReader& reader, const std::shared_ptr<const Holes>& holes, std::size_t most) {
    const auto width = reader.get<std::int32_t>();
    const auto depth = reader.get<std::int32_t>();
    const std::size_t count = getCount(reader, 1);
    if (count > most) {
        throw FormatError("a TIN of " + std::to_string(count) + " vertices; this field has at most " +
                          std::to_string(most));
    }
    std::vector<std::optional<LatticePoint>> places(count);
    std::vector<std::int64_t> volumes(places.size(), 0);
    std::vector<std::uint8_t> moving(places.size(), 0);
    for (std::size_t i = 0; i < places.size(); ++i) {
        const std::uint64_t first = reader.getVarint();  // 0 for a number without a vertex
        if (first > 0) {
            moving[i] = static_cast<std::uint8_t>((first - 1) % 2);
            const std::int32_t x = getCoordinate((first - 1) / 2);
            places[i] = LatticePoint{x, getCoordinate(reader.getVarint())};
            volumes[i] = reader.getSigned();
        }
    }
    if (places.empty() || !places.back()) {
        throw FormatError("a TIN that does not end with a vertex");
    }
    const auto constraints = getConstraints(reader, places.size());
    try {
        VertexSand layer(Mesh::restore(width, depth, places, constraints, holes));
        for (std::size_t i = 0; i < volumes.size(); ++i) {
            // All heights of 32-bit integers are within ±2^32.
            const Wide highest = static_cast<Wide>(layer.stars_[i]) << 32U;
            if (volumes[i] > highest || volumes[i] < -highest) {
                throw FormatError("a vertex with too much sand");
            }
            if (places[i]) {
                layer.add(static_cast<Vertex>(i), volumes[i]);
                layer.setMoving(static_cast<Vertex>(i), moving[i] != 0);
            }
        }
        if (layer.magnitude_ > kMostSand + kRounding) {
            throw FormatError("a TIN with more sand than 64 bits can count");
        }
        if (layer.mesh_.constraints() != constraints) {
            throw FormatError("constraints that differ from those of the mesh");
        }
        return layer;
    } catch (const std::invalid_argument& wrong) {
        throw FormatError(std::string("not a TIN: ") + wrong.what());
    } catch (const std::overflow_error& wrong) {
        throw FormatError(std::string("not a TIN: ") + wrong.what());
    }
}

}  // namespace sand::tin
