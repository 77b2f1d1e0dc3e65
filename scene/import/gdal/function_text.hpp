// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include "scene/import/importer.hpp"

namespace scene {

/// Importer::evaluate(). Trigonometry and powers may differ in a last bit between C libraries: whoever loads a scene
/// evaluates it once, and its heights as whole numbers travel.
[[nodiscard]] EsriGrid evaluateFunction(const Function& function);

}  // namespace scene
