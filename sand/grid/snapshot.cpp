// SPDX-License-Identifier: Apache-2.0
#include "sand/grid/snapshot.hpp"

#include <cstdlib>
#include <utility>

#include "sand/model/grid_codec.hpp"

namespace sand::grid {
namespace {

/// Throws unless volume and outflow are possible for a field whose heights are within ±kMaxHeight.
void requirePossible(const Snapshot& copy) {
    const std::int64_t most =
        std::int64_t{kMaxHeight} * copy.field.columns() * copy.field.rows();  // [unit · cell], at most 2^56
    const bool possible = copy.outflow >= -2 * most && copy.outflow <= 2 * most;
    if (!possible || std::abs(copy.field.volume() + copy.outflow) > most) {
        throw base::FormatError("sand whose outflow is more than all of its sand");
    }
}

/// Throws if the surface of the sand lies below rock. Sand of negative thickness would draw sand out of its neighbours
/// until heights overflow.
void requireAbove(const Ground& ground, const HeightField& field) {
    for (int y = 0; y < field.rows(); ++y) {
        for (int x = 0; x < field.columns(); ++x) {
            if (ground.sand(x, y, field.height(x, y)) < 0) {
                throw base::FormatError("rock above the sand that lies on it");
            }
        }
    }
}

}  // namespace

void Snapshot::encodeInto(base::ByteWriter& writer, const std::function<void()>& between) const {
    writer.put(outflow);
    encodeCells(field.cells(), field.bounds(), writer, between);
    inertia.encode(field.columns(), field.rows(), writer, between);
}

std::size_t Snapshot::stripes() const {
    return stripesOf(field.bounds()) + inertia.stripes(field.columns(), field.rows());
}

Snapshot Snapshot::decode(std::span<const std::uint8_t> bytes, const SandLimits& limits,
                          const std::function<void(std::size_t)>& decoded) {
    base::ByteReader reader(bytes);
    const auto outflow = reader.get<std::int64_t>();
    Snapshot copy(HeightField(limits.faces.columns, limits.faces.rows, limits.cellSize), {}, outflow);
    decodeCells(reader, copy.field.bounds(), kMaxHeight, copy.field.cells(), decoded);
    requirePossible(copy);
    if (limits.ground != nullptr) {
        requireAbove(*limits.ground, copy.field);
    }
    copy.inertia = Inertia::decode(reader, limits.faces, decoded);
    if (!reader.atEnd()) {
        throw base::FormatError("sand with further bytes behind it");
    }
    return copy;
}

}  // namespace sand::grid
