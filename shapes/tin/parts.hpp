// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shapes/model/surface_parts.hpp"
#include "shapes/tin/geometry.hpp"

namespace shapes {

/// The surface of a TIN as one part, which is made again whenever the sand is taken. Empty before.
class TinParts final : public SurfaceParts {
public:
    explicit TinParts(double cellSize /* [scene unit] */) : geometry_{.cellSize = cellSize} {}

    [[nodiscard]] Change take(const sand::SurfaceData& data) override;
    [[nodiscard]] std::size_t vertices() const override { return geometry_.vertices.size(); }
    [[nodiscard]] SurfacePart part(int number) const override;
    [[nodiscard]] std::vector<std::uint32_t> triangles(int part) const override;
    [[nodiscard]] PlaceUniforms places() const override;
    [[nodiscard]] SandRim rim() const override;
    [[nodiscard]] float lowest() const override;

private:
    std::int32_t width_ = 0, depth_ = 0;  // [probe unit]
    TinGeometry geometry_;
    bool hasHoles_ = false;
};

}  // namespace shapes
