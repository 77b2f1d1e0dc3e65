// SPDX-License-Identifier: Apache-2.0
#include "sand/grid/snapshot.hpp"

#include <utility>
namespace sand::grid {
namespace {

/// Checks the heights of sand, row by row.
class PossibleSand {
public:
    /// Throws if no field with heights within ±kMaxHeight can have lost so much.
    PossibleSand(const SandLimits& limits, std::int64_t outflow /* [unit · cell] */)
        : limits_(limits), most_(std::int64_t{kMaxHeight} * limits.faces.columns * limits.faces.rows), sum_(outflow) {
        if (outflow < -2 * most_ || outflow > 2 * most_) {
            refuse();
        }
    }

    /// Throws if the surface of the sand lies below rock. Sand of negative thickness would draw sand out of its
    /// neighbours until heights overflow.
    void take(int y, const std::int32_t* row) {
        for (int x = 0; x < limits_.faces.columns; ++x) {
            sum_ += row[x];
            if (limits_.ground != nullptr && limits_.ground->sand(x, y, row[x]) < 0) {
                throw base::FormatError("rock above the sand that lies on it");
            }
        }
    }
    /// Throws unless volume and outflow are possible together. Call it after all rows.
    void finish() const {
        if (sum_ < -most_ || sum_ > most_) {
            refuse();
        }
    }

private:
    [[noreturn]] static void refuse() { throw base::FormatError("sand whose outflow is more than all of its sand"); }

    const SandLimits& limits_;
    std::int64_t most_, sum_;  // [unit · cell]; `most_` is at most 2^56
};

}  // namespace

void encodeSand(const CellRect& field, const std::function<const std::int32_t*(int row)>& rowOf, const SandRest& rest,
                base::ByteWriter& writer, const std::function<void()>& between) {
    writer.put(rest.outflow);
    encodeRows(field, rowOf, writer, between);
    rest.inertia.encode(field.x1, field.y1, writer, between);
}

SandRest decodeSand(std::span<const std::uint8_t> bytes, const SandLimits& limits, const RowsToDecode& take,
                    const std::function<void(std::size_t)>& decoded) {
    base::ByteReader reader(bytes);
    SandRest rest;
    rest.outflow = reader.get<std::int64_t>();
    PossibleSand possible(limits, rest.outflow);
    const std::int32_t* row = nullptr;
    const RowsToDecode checked{[&](int y) {
                                   std::int32_t* const place = take.rowOf(y);
                                   row = place;
                                   return place;
                               },
                               [&](int y) {
                                   possible.take(y, row);
                                   if (take.done) {
                                       take.done(y);
                                   }
                               }};
    decodeRows(reader, {0, 0, limits.faces.columns, limits.faces.rows}, kMaxHeight, checked, decoded);
    possible.finish();
    rest.inertia = Inertia::decode(reader, limits.faces, decoded);
    if (!reader.atEnd()) {
        throw base::FormatError("sand with further bytes behind it");
    }
    return rest;
}

void Snapshot::encodeInto(base::ByteWriter& writer, const std::function<void()>& between) const {
    encodeSand(
        field.bounds(), [this](int row) { return field.row(row); }, {inertia, outflow}, writer, between);
}

std::size_t Snapshot::stripes() const {
    return stripesOf(field.bounds()) + inertia.stripes(field.columns(), field.rows());
}

Snapshot Snapshot::decode(std::span<const std::uint8_t> bytes, const SandLimits& limits,
                          const std::function<void(std::size_t)>& decoded) {
    HeightField field(limits.faces.columns, limits.faces.rows, limits.cellSize);
    SandRest rest = decodeSand(bytes, limits, {[&field](int y) { return field.row(y); }}, decoded);
    return {std::move(field), std::move(rest.inertia), rest.outflow};
}

}  // namespace sand::grid
