// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sand/ground.hpp"
#include "sand/height_field.hpp"
#include "sand/tin/layer.hpp"
#include "sand/tin/start.hpp"

namespace sand::tin {

/// The sand that a start describes.
[[nodiscard]] Layer layerOf(const Start& start);

/// As sand::TinModule's.
[[nodiscard]] Start follow(const HeightField& field, const Ground* walls, const Settings& settings);
[[nodiscard]] Start join(const Start& start);
/// Heights are rounded to whole units; settings are those of the surface's own start.
[[nodiscard]] Start startOf(const Layer& layer, const Settings& settings);

}  // namespace sand::tin
