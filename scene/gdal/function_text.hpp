// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include "scene/import/importer.hpp"

namespace scene {

/// Does the work of Importer::evaluate(). Trigonometry and powers may differ in the last bit between C libraries. Only
/// the process that loads a scene therefore evaluates it, and sends the heights as whole numbers.
[[nodiscard]] EsriGrid evaluateFunction(const Function& function, const RasterCheck& check);

}  // namespace scene
