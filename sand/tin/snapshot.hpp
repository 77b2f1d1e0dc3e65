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

/// The state of a TIN beside its VertexSand.
struct TinState {
    Imprint imprint;           // of the tool that stands in it
    Vertex nextToGo = 0;       // where coarsening goes on
    std::int64_t outflow = 0;  // [volume unit] lost over an open rim

    void encode(base::ByteWriter& writer) const;
    /// Throws base::FormatError.
    static TinState decode(base::ByteReader& reader);
};

/// The sand of a TIN as bytes: what is saved, loaded and put back.
class Snapshot final : public SurfaceCopy {
public:
    Snapshot(const VertexSandParts& layer, TinState state);
    Snapshot(const VertexSand& layer, TinState state) : Snapshot(layer.parts(), std::move(state)) {}
    /// Throws base::FormatError for bytes that are no TIN of this size with these holes, or go on behind it.
    Snapshot(std::span<const std::uint8_t> packed, std::int32_t width, std::int32_t depth,
             std::shared_ptr<const Holes> holes = nullptr);

    [[nodiscard]] base::Bytes encode() const override;
    [[nodiscard]] VertexSand layer() const;
    [[nodiscard]] const TinState& state() const { return state_; }

private:
    base::Bytes plain_;  // the VertexSand, encoded
    std::shared_ptr<const Holes> holes_;
    TinState state_;
};

}  // namespace sand::tin
