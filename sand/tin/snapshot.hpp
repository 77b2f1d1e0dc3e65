// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <cstdint>
#include <span>
#include <utility>

#include "sand/model/surface.hpp"
#include "sand/tin/tool/displacement.hpp"
#include "sand/tin/volume/vertex_sand.hpp"

namespace sand::tin {

/// The state of a TIN that is not in its VertexSand.
struct TinState {
    Imprint imprint;           // imprint of the tool in the sand
    Vertex nextToGo = 0;       // vertex at which coarsening continues
    std::int64_t outflow = 0;  // volume lost over an open rim [volume unit]

    void encode(base::ByteWriter& writer) const;
    /// Throws base::FormatError if the bytes are not a TinState of a mesh with at most `mostVertices`.
    static TinState decode(base::ByteReader& reader, std::size_t mostVertices = VertexSand::kMostNumbers);
};

/// Limits of the sand of one field, which follow from its start.
struct SandLimits {
    std::int32_t width = 0, depth = 0;        // size [probe unit]
    std::shared_ptr<const Holes> holes = {};  // null if there are none
    std::size_t mostVertices = 0;             // that a replica of the start can have
};

/// Snapshot of a TIN's sand as bytes, for saving, loading and undo.
class Snapshot final : public SurfaceCopy {
public:
    Snapshot(const VertexSandParts& layer, TinState state);
    Snapshot(const VertexSand& layer, TinState state) : Snapshot(layer.parts(), std::move(state)) {}
    /// Throws base::FormatError if `packed` is not a TIN within `limits`, or if further bytes follow. Volume and
    /// outflow together must be within ±kMostSand; steps keep that sum. Allocates memory only for limits.mostVertices.
    Snapshot(std::span<const std::uint8_t> packed, const SandLimits& limits);

    void encodeInto(base::ByteWriter& writer, const std::function<void()>& between) const override;
    [[nodiscard]] VertexSand layer() const;
    [[nodiscard]] const TinState& state() const { return state_; }

private:
    base::Bytes plain_;  // the VertexSand, encoded
    std::shared_ptr<const Holes> holes_;
    std::size_t mostVertices_ = VertexSand::kMostNumbers;
    TinState state_;
};

}  // namespace sand::tin
