// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "sand/model/ground.hpp"
#include "sand/model/height_field.hpp"
#include "sand/model/rules.hpp"
#include "sand/model/surface_data.hpp"
#include "sand/tin/geometry/tin_start.hpp"

namespace sand {

/// Size of a field, which a scene file or rules give before there is memory for its sand.
struct FieldSize {
    std::int32_t columns = 0, rows = 0;  // [cell]
    bool nominal = false;                // whether a TIN is made of the field

    static FieldSize of(const Rules& rules);

    /// Returns a lower bound of the memory for a replica and its Start [byte]. Returns nullopt for a TIN: only its
    /// Start gives the number of vertices, but a Start of vertices takes little memory.
    [[nodiscard]] std::optional<std::int64_t> bytesOfReplica() const;
    /// Returns the memory for a height per cell [byte]. A scene is loaded as heights, and a TIN is then made of them.
    [[nodiscard]] std::int64_t bytesOfHeights() const;
    /// Returns a lower bound of the memory for a scene of this size and a replica of it [byte].
    [[nodiscard]] std::int64_t leastBytes() const { return bytesOfReplica().value_or(bytesOfHeights()); }
    /// Returns "300 x 200 cells" or "300 x 200 nominal cells of a TIN".
    [[nodiscard]] std::string text() const;
    friend bool operator==(const FieldSize&, const FieldSize&) = default;
};

/// Returns the heights that Start::packed has.
[[nodiscard]] HeightField unpackedHeights(const base::Bytes& packed, int columns, int rows,
                                          double cellSize /* [scene unit] */);

/// Size of some sand in a message of too little memory, such as "300 x 200 cells", and what saves memory: "fewer
/// cells".
struct SizeText {
    std::string what;
    std::string_view fewer;
};

/// Rules, sand and ground that a replica begins with. Equal starts and equal steps make equal sand.
struct Start {
    Rules rules;
    HeightField terrain{1, 1, 1.0};            // for a TIN one cell, which gives the nominal cell size
    std::shared_ptr<const tin::TinStart> tin;  // null for a height field
    std::shared_ptr<const Ground> ground;      // null without rock and wall cells
    /// `terrain` as encodeCells() writes it. Encoding and all replicas of this Start share these bytes. Null unless
    /// pack() or decodeSand() has set it. `terrain` must not change while it is set.
    std::shared_ptr<const base::Bytes> packed;
    /// Volume of the heights that takeHeights() or dropHeights() has taken [unit · cell]; nullopt before.
    std::optional<std::int64_t> volumeTaken;

    [[nodiscard]] double toolRadius() const {  // [scene unit]
        return rules.tuning.tool.radius * terrain.cellSize() / kProbePerCell;
    }
    /// Returns whether a replica of this sand records sand::Movement.
    [[nodiscard]] bool recordsMovement() const;
    /// Makes the TIN `start` the sand that a replica begins with. Sets `tin`, `terrain` and `rules.tin`; keeps the cell
    /// size.
    void beginAs(tin::TinStart start);
    /// Sets `packed`. Calls `between` as encodeCells() does.
    void pack(const std::function<void()>& between = {});
    /// Writes heights, TIN and ground. The rules and the cell size are written elsewhere.
    void encodeSand(base::ByteWriter& writer) const;
    enum class Keep : bool { heights, packedToo };
    /// Reads what encodeSand() wrote, and sets `packed` if `keep` says so. `rules` must have been read. Throws
    /// base::FormatError for bytes that are not the sand of these rules. Calls `decoded` for the heights as
    /// decodeCells() does.
    void decodeSand(base::ByteReader& reader, double cellSize /* [scene unit] */, Keep keep,
                    const std::function<void(std::size_t)>& decoded = {});

    /// Gives the heights of a height field to the caller. Their mean and volume stay, as does `packed`.
    [[nodiscard]] HeightField takeHeights();
    /// Returns the heights that takeHeights() has taken, unpacked from `packed`. Throws std::logic_error without it.
    [[nodiscard]] HeightField heightsAgain() const;
    /// Returns whether `terrain` has the heights of `other`, the `packed` of a Start of the same size.
    [[nodiscard]] bool hasHeights(const base::Bytes& other) const;
    /// Frees the heights and `packed`, because all replicas have been made. Rules, cell size, TIN, ground, and the mean
    /// and volume of the heights stay. For a TIN, changes nothing.
    void dropHeights();

    /// Returns the heights that the sand begins with. Throws std::logic_error for a TIN, which gets its triangles from
    /// a replica.
    [[nodiscard]] SurfaceData data() const;
    /// Returns the middle of a height field with its rock and walls, at most `most` cells along a side; nullopt for a
    /// TIN.
    [[nodiscard]] std::optional<Start> middle(int most) const;
    /// Returns the mean height of the sand as a whole number [unit]. Devices hover and dig relative to it.
    [[nodiscard]] std::int32_t referenceHeight() const;

    /// Returns a lower bound of the memory for a replica and this Start [byte].
    [[nodiscard]] std::int64_t leastBytes() const;
    /// Returns a lower bound of the further memory that a program needs to draw the sand [byte].
    [[nodiscard]] std::int64_t bytesToDraw() const;
    /// Returns the volume of the heights [unit · cell]; nullopt for a TIN, whose volume takes seconds (volumeOf()).
    [[nodiscard]] std::optional<std::int64_t> volumeOfHeights() const;
    /// Returns an upper bound of Replica::encodeState() for a height field, at most 2^32 - 2^26 [byte]; 0 for a TIN.
    [[nodiscard]] std::int64_t mostStateBytes() const;
    [[nodiscard]] SizeText sizeText() const;
};

}  // namespace sand
